//! Caps of a surface, each made when it is first asked for.

use std::sync::{Arc, OnceLock};

use super::{Surface, primvar};
use crate::cap::{Cap, CapError, CapOptions, ValenceCap};
use crate::parallel::map_indexed;
use crate::rings::{Rings, ValenceRules};

/// The caps around the points of a surface.
#[derive(Debug)]
pub(super) struct Caps {
    pub(super) options: CapOptions,
    /// Per point the rules, shared among those alike, and the cap.
    around: Vec<(Arc<ValenceCap>, OnceLock<Cap>)>,
}

impl Caps {
    /// # Errors
    ///
    /// If the caps do not fit the rings of some point.
    fn new(rings: &[Rings], options: CapOptions) -> Result<Self, CapError> {
        let mut kinds: Vec<&ValenceRules> = Vec::new();
        let kind_of = |rings: &Rings, kinds: &[&ValenceRules]| {
            kinds.iter().position(|&rules| std::ptr::eq(rules, rings.rules()))
        };
        for rings in rings {
            if kind_of(rings, &kinds).is_none() {
                kinds.push(rings.rules());
            }
        }
        let made = map_indexed(kinds.len(), |k| ValenceCap::new(kinds[k], options.kind));
        let rules: Vec<Arc<ValenceCap>> =
            made.into_iter().map(|rules| Ok(Arc::new(rules?))).collect::<Result<_, CapError>>()?;
        let around = rings.iter().map(|rings| {
            let kind = kind_of(rings, &kinds).expect("all kinds are listed");
            (Arc::clone(&rules[kind]), OnceLock::new())
        });
        Ok(Self { options, around: around.collect() })
    }

    /// Forgets the cap of a point whose rings have changed.
    pub(super) fn forget(&mut self, point: usize) {
        self.around[point].1 = OnceLock::new();
    }
}

impl Surface {
    /// Replaces the rings behind the first `options.rings` by caps, finitely many patches; `None` for
    /// rings without end.
    ///
    /// A surface that is closed like this has derivatives at extraordinary points too, and curvature
    /// where there is a tangent plane. Takes some hundredths of a second per valence; caps themselves
    /// are made when first asked for.
    ///
    /// # Errors
    ///
    /// [`CapError`] if there are no such caps for the rings; the surface stays as it was.
    pub fn set_caps(&mut self, options: Option<CapOptions>) -> Result<(), CapError> {
        self.caps = options.map(|options| Caps::new(&self.rings, options)).transpose()?;
        // Channels are closed likewise.
        self.channels = primvar::unbuilt(&self.cage);
        Ok(())
    }

    /// The rules of the cap around an extraordinary point, by its index.
    pub(crate) fn cap_rules(&self, point: usize) -> Option<&Arc<ValenceCap>> {
        self.caps.as_ref().map(|caps| &caps.around[point].0)
    }

    /// How the surface is closed, if it is.
    pub fn cap_options(&self) -> Option<CapOptions> {
        self.caps.as_ref().map(|caps| caps.options)
    }

    /// The cap around an extraordinary point, by its index; `None` if rings go on for ever.
    pub fn cap(&self, point: usize) -> Option<&Cap> {
        let caps = self.caps.as_ref()?;
        let (rules, cap) = &caps.around[point];
        let make = || Cap::with_rules(&self.rings[point], caps.options.rings, rules);
        Some(cap.get_or_init(make))
    }
}
