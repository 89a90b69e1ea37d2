//! Nothing but the examples of the repository's README, to be tested: the README lies outside of
//! the library's folder, and so is not in its package.

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
