//! Which mesh is meant, and where it stands.

use super::UsdError;
use super::parse::{Layer, Prim};
use crate::io::excerpt::excerpt;

/// A mesh of a layer.
pub(super) struct Found<'a> {
    /// As in `/World/Cage`.
    pub path: String,
    /// The prims from the top down to the mesh itself.
    pub chain: Vec<&'a Prim>,
}

impl<'a> Found<'a> {
    /// The prim of the mesh.
    pub fn prim(&self) -> &'a Prim {
        self.chain[self.chain.len() - 1]
    }

    /// What is not followed on the way to the mesh, in sentences.
    pub fn remarks(&self) -> impl Iterator<Item = String> {
        let arcs = self.chain.iter().flat_map(|prim| prim.arcs.iter().map(move |arc| (prim, arc)));
        arcs.map(|(prim, arc)| {
            format!("`{arc}` of the prim `{}` is not followed", excerpt(prim.name.as_bytes()))
        })
    }
}

/// The mesh at the path `wanted` or the only one below it; the only one of all if there is no
/// path.
pub(super) fn find_mesh<'a>(layer: &'a Layer, wanted: Option<&str>) -> Result<Found<'a>, UsdError> {
    let mut meshes = Vec::new();
    for prim in &layer.prims {
        collect(prim, &mut Found { path: String::new(), chain: Vec::new() }, &mut meshes);
    }
    let all = paths(&meshes);
    let wanted = wanted.map(|path| path.trim_end_matches('/')).filter(|path| !path.is_empty());
    if let Some(wanted) = wanted {
        meshes.retain(|mesh| {
            let rest = mesh.path.strip_prefix(wanted);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        });
    }
    let fault = |message| Err(UsdError { line: layer.num_lines, message });
    match (meshes.len(), wanted) {
        (1, _) => Ok(meshes.remove(0)),
        (0, None) => fault(no_mesh(layer)),
        (0, Some(wanted)) => fault(format!(
            "there is no mesh at or below the path `{}`, but {all}",
            excerpt(wanted.as_bytes())
        )),
        (count, _) => fault(format!(
            "there are {count} meshes ({}): choose one by its path (--prim)",
            paths(&meshes)
        )),
    }
}

/// Adds the meshes at or below `prim`, whose parent is at `parent`.
fn collect<'a>(prim: &'a Prim, parent: &mut Found<'a>, meshes: &mut Vec<Found<'a>>) {
    if !prim.is_defined || !prim.is_active {
        return;
    }
    let len = parent.path.len();
    parent.path.push('/');
    parent.path.push_str(&prim.name);
    parent.chain.push(prim);
    if prim.type_name == "Mesh" {
        meshes.push(Found { path: parent.path.clone(), chain: parent.chain.clone() });
    }
    for child in &prim.children {
        collect(child, parent, meshes);
    }
    parent.path.truncate(len);
    parent.chain.pop();
}

fn no_mesh(layer: &Layer) -> String {
    fn has_arcs(prim: &Prim) -> bool {
        !prim.arcs.is_empty() || prim.children.iter().any(has_arcs)
    }
    let remedy = if layer.prims.iter().any(has_arcs) {
        "references and variants are not followed: write it by `usdcat --flatten`"
    } else {
        "define one as in `def Mesh \"Cage\" { ... }`"
    };
    format!("there is no mesh; {remedy}")
}

/// The paths of the first few meshes.
fn paths(meshes: &[Found]) -> String {
    /// Enough to see what paths are like.
    const SHOWN: usize = 8;
    let shown = meshes.iter().take(SHOWN).map(|mesh| excerpt(mesh.path.as_bytes()));
    let mut text = shown.collect::<Vec<_>>().join(", ");
    match meshes.len() {
        0 => text += "none elsewhere",
        count if count > SHOWN => text += &format!(" and {} more", count - SHOWN),
        _ => {}
    }
    text
}
