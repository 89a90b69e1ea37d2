//! The chapters of the documentation: what the rules are, where they come from, how good they are.
//!
//! They are the files `docs/*.md` of the crate. Pictures are in the repository only, beside the
//! chapters; their descriptions stand in their places here. Chapters cite as `[Key, eq. 12]`, with
//! the keys of `docs/refs.bib`.
#![allow(rustdoc::broken_intra_doc_links, reason = "citations stand in brackets")]

/// A chapter as a module: its name, its file, and the links that differ from those of the file.
macro_rules! chapter {
    ($name:ident, $file:literal $(, $links:literal)?) => {
        $(#[doc = $links])?
        #[doc = include_str!(concat!("../docs/", $file))]
        pub mod $name {}
    };
}

chapter!(notation, "01-notation.md");
chapter!(surface, "02-surface.md");
chapter!(nets, "03-nets.md");
chapter!(guide, "04-guide.md");
chapter!(tables, "05-tables.md");
chapter!(shape, "06-shape.md");
chapter!(guided, "07-guided.md", "[Chapter 10]: super::basis\n");
chapter!(fair, "08-fair.md");
chapter!(caps, "09-caps.md");
chapter!(basis, "10-basis.md");
chapter!(boundaries_and_creases, "11-boundaries-and-creases.md");
chapter!(files, "12-files.md");
chapter!(opensubdiv, "13-opensubdiv.md");
chapter!(glossary, "14-glossary.md");
