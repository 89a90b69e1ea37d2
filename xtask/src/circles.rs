//! Circles of files, which `cargo xtask tidy` refuses.
//!
//! At every module, take its children, each together with all that lies below it, and draw an
//! arrow from child A to child B if a file of A names something of B. No arrows may run in a
//! circle:
//!
//! ```text
//!          io                        io
//!        /  |  \                   /  |  \
//!     load  kind  obj           load  kind  obj         load -> obj -> load is a circle;
//!       '---------->'             '--->'<----'          load -> kind, obj -> kind is none
//!       '<----------'
//! ```
//!
//! What a module says itself, in its own file, is the common ground of its children: a child may
//! use it, and the module may use and re-export its children, as `mod.rs` does. A re-export is
//! looked through: who names `super::X`, which the parent takes from a child by `use`, names that
//! child.
//!
//! Read are the paths that begin with `crate::`, `super::` or `self::` outside of comments and
//! tests; no other path can leave a module without a `use`.

use std::collections::{BTreeMap, BTreeSet};

/// A module by its names from the root of the crate; the root has none.
type Module = Vec<String>;

/// Finds the circles in the files of one crate, each given by its path below `src` and its text, as
/// one sentence for each.
pub fn circles(files: &[(String, String)]) -> Vec<String> {
    let modules: BTreeMap<Module, Source> =
        files.iter().map(|(path, text)| (module_of(path), Source::read(path, text))).collect();
    let mut arrows: BTreeMap<Module, Arrows> = BTreeMap::new();
    for (module, source) in &modules {
        for path in &source.paths {
            let Some(used) = resolved(module, path, &modules, MAX_RENAMINGS) else { continue };
            let common = module.iter().zip(&used).take_while(|(a, b)| a == b).count();
            if common < module.len() && common < used.len() {
                let at = arrows.entry(module[..common].to_vec()).or_default();
                at.entry(module[common].clone()).or_default().insert(used[common].clone());
            }
        }
    }
    let circles = arrows.iter().flat_map(|(parent, arrows)| {
        let name =
            |child: &String| [parent.as_slice(), std::slice::from_ref(child)].concat().join("::");
        strong_components(arrows).into_iter().map(move |circle| {
            let names: Vec<String> = circle.iter().map(name).collect();
            format!("{} use each other in a circle", names.join(", "))
        })
    });
    circles.collect()
}

/// From each child of a module to the children that it uses.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// What one file says of others.
#[derive(Default)]
struct Source {
    /// The paths in it that begin with `crate`, `super` or `self`.
    paths: Vec<Vec<String>>,
    /// Names that it takes from others by `use`, with the paths to them.
    imports: BTreeMap<String, Vec<String>>,
}

impl Source {
    fn read(file: &str, text: &str) -> Self {
        let code = if file.starts_with("bin/") { text } else { code_of(text) };
        let code: String = code.lines().map(without_comment).collect::<Vec<_>>().join("\n");
        let mut source = Self::default();
        for start in ["crate::", "super::", "self::"] {
            for (at, _) in code.match_indices(start) {
                let before = code[..at].chars().next_back();
                if before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':') {
                    source.paths.extend(leaves(&code[at..]).into_iter().map(|(path, _)| path));
                }
            }
        }
        for (at, _) in code.match_indices("use ") {
            let is_word = code[..at].chars().next_back().is_none_or(char::is_whitespace);
            if is_word {
                let named = leaves(&code[at + 4..]).into_iter();
                source.imports.extend(named.map(|(path, name)| (name, path)));
            }
        }
        source
    }
}

/// The file up to its tests.
fn code_of(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod").next().unwrap_or_default()
}

fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// The module of a file below `src`.
fn module_of(path: &str) -> Module {
    let stem = path.trim_end_matches(".rs");
    let mut names: Module = stem.split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|name| ["mod", "lib", "main"].contains(&name.as_str())) {
        names.pop();
    }
    names
}

/// The paths at the ends of the tree of a `use`, or the single path, at the beginning of `text`,
/// each with the name that it gets.
fn leaves(text: &str) -> Vec<(Vec<String>, String)> {
    let mut found = Vec::new();
    tree(text, &[], &mut found);
    found
}

/// Reads one tree after the path `outer`; returns what stands behind it.
fn tree<'a>(text: &'a str, outer: &[String], found: &mut Vec<(Vec<String>, String)>) -> &'a str {
    let mut path = outer.to_vec();
    let mut rest = text.trim_start();
    loop {
        if let Some(inside) = rest.strip_prefix('{') {
            rest = inside.trim_start();
            while !rest.is_empty() && !rest.starts_with('}') {
                let after = tree(rest, &path, found).trim_start();
                if after.len() == rest.len() {
                    return ""; // no tree of a `use`: a block
                }
                rest = after.trim_start_matches(',').trim_start();
            }
            return rest.strip_prefix('}').unwrap_or_default();
        }
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_' && c != '*');
        let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
        if word.is_empty() {
            return rest;
        }
        if word != "self" || path.is_empty() {
            path.push(word.to_owned());
        }
        rest = after;
        match rest.strip_prefix("::") {
            Some(inside) => rest = inside,
            None => break,
        }
    }
    let mut name = path.last().cloned().unwrap_or_default();
    if let Some(renamed) = rest.strip_prefix(" as ") {
        let end = renamed.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(renamed.len());
        name = renamed[..end].to_owned();
        rest = &renamed[end..];
    }
    found.push((path, name));
    rest
}

/// Re-exports of re-exports are looked through so often.
const MAX_RENAMINGS: usize = 8;

/// The module that a path in `module` leads to, through `renamings` re-exports at most; `None` out
/// of the crate.
fn resolved(
    module: &Module,
    path: &[String],
    modules: &BTreeMap<Module, Source>,
    renamings: usize,
) -> Option<Module> {
    let mut at = module.clone();
    let mut words = path.iter().peekable();
    match words.peek()?.as_str() {
        "crate" => {
            at.clear();
            words.next();
        }
        "self" => {
            words.next();
        }
        "super" => {
            while words.next_if(|word| *word == "super").is_some() {
                at.pop()?;
            }
        }
        _ => {}
    }
    while let Some(word) = words.next() {
        let child = [at.as_slice(), std::slice::from_ref(word)].concat();
        if modules.contains_key(&child) {
            at = child;
            continue;
        }
        let import = modules.get(&at)?.imports.get(word);
        return match import.filter(|_| renamings > 0) {
            Some(import) => {
                let rest: Vec<String> = words.cloned().collect();
                resolved(&at, &[import.as_slice(), &rest].concat(), modules, renamings - 1)
            }
            None => Some(at),
        };
    }
    Some(at)
}

/// The sets of two and more names that reach each other.
fn strong_components(arrows: &Arrows) -> Vec<Vec<String>> {
    let reach = |from: &String| {
        let mut reached = BTreeSet::new();
        let mut open = vec![from];
        while let Some(name) = open.pop() {
            for next in arrows.get(name).into_iter().flatten() {
                if reached.insert(next) {
                    open.push(next);
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&String, BTreeSet<&String>> =
        arrows.keys().map(|name| (name, reach(name))).collect();
    let both = |a: &String, b: &String| reached[a].contains(b) && reached[b].contains(a);
    let mut components: BTreeSet<Vec<String>> = BTreeSet::new();
    for a in arrows.keys().filter(|a| reached[a].contains(a)) {
        components.insert(arrows.keys().filter(|b| both(a, b)).cloned().collect());
    }
    components.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let owned = |&(path, text): &(&str, &str)| (path.to_owned(), text.to_owned());
        circles(&files.iter().map(owned).collect::<Vec<_>>())
    }

    #[test]
    fn siblings_that_use_each_other_are_a_circle() {
        let a = ("a.rs", "use crate::b::{self, X};\n");
        assert!(found(&[("lib.rs", "mod a;\nmod b;"), a, ("b.rs", "struct X;")]).is_empty());
        for b in ["fn f() { super::a::g() }", "use crate::{a::g, c};", "use crate::a;"] {
            let circles = found(&[("lib.rs", ""), a, ("b.rs", b)]);
            assert_eq!(circles, ["a, b use each other in a circle"], "{b}");
        }
    }

    #[test]
    fn files_below_count_as_their_module() {
        let files = [
            ("lib.rs", ""),
            ("a.rs", "mod inner;"),
            ("a/inner.rs", "use crate::b::X;"),
            ("b.rs", "mod below;"),
            ("b/below.rs", "use crate::c::Y;"),
            ("c/mod.rs", "use crate::a::Z;"),
        ];
        assert_eq!(found(&files), ["a, b, c use each other in a circle"]);
    }

    #[test]
    fn a_parent_is_common_ground_and_its_re_exports_are_looked_through() {
        let parent = ("m/mod.rs", "mod a;\nmod b;\npub use a::{X as Y};\npub struct Own;");
        let a = ("m/a.rs", "use super::b::Z;");
        assert!(found(&[parent, a, ("m/b.rs", "use super::Own;")]).is_empty());
        assert!(found(&[parent, a, ("m/b.rs", "use super::X;")]).is_empty());
        let circles = found(&[parent, a, ("m/b.rs", "use super::Y;")]);
        assert_eq!(circles, ["m::a, m::b use each other in a circle"]);
    }

    #[test]
    fn comments_and_tests_do_not_count() {
        let a = ("a.rs", "use crate::b::X;");
        for b in [
            "//! [`crate::a`]\n",
            "struct X; // super::a\n",
            "#[cfg(test)]\nmod tests {\n    use crate::a::g;\n}",
        ] {
            assert!(found(&[("lib.rs", ""), a, ("b.rs", b)]).is_empty(), "{b}");
        }
    }
}
