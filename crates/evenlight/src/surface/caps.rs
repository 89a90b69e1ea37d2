//! Caps of a surface, each made when it is first asked for.

use std::sync::{Arc, OnceLock};

use super::{Layout, Surface, primvar};
use crate::cap::{Cap, CapError, CapOptions, ValenceCap};
use crate::task::map_indexed;

/// How the surfaces over a layout are closed, without any values.
#[derive(Debug)]
pub(crate) struct CapPlan {
    pub(crate) options: CapOptions,
    /// The rules of the cap of every point.
    rules: Vec<Arc<ValenceCap>>,
}

impl CapPlan {
    /// # Errors
    ///
    /// If the caps do not fit the rings of some point.
    pub(crate) fn new(layout: &Layout, options: CapOptions) -> Result<Self, CapError> {
        options.check_rings()?;
        let points = layout.extraordinary_points().len();
        // Made by the first point of every kind; the others find them made.
        let made = map_indexed(points, |point| layout.rules(point).cap(options.kind));
        Ok(Self { options, rules: made.into_iter().collect::<Result<_, CapError>>()? })
    }

    /// The rules of the cap of a point.
    pub(crate) fn rules(&self, point: usize) -> &ValenceCap {
        &self.rules[point]
    }
}

/// The caps around the points of a surface.
#[derive(Debug)]
pub(super) struct Caps<const N: usize> {
    pub(super) plan: Arc<CapPlan>,
    made: Vec<OnceLock<Cap<N>>>,
}

impl<const N: usize> Caps<N> {
    fn new(plan: Arc<CapPlan>) -> Self {
        let made = plan.rules.iter().map(|_| OnceLock::new()).collect();
        Self { plan, made }
    }

    /// Such caps of other values.
    pub(super) fn unmade(&self) -> Self {
        Self::new(self.plan.clone())
    }

    /// Forgets the cap of a point whose rings have changed.
    pub(super) fn forget(&mut self, point: usize) {
        self.made[point] = OnceLock::new();
    }
}

impl<const N: usize> Surface<N> {
    /// Replaces the rings behind the first `options.rings` by caps, finitely many patches; `None`
    /// for rings without end.
    ///
    /// A surface that is closed like this has derivatives at extraordinary points too, and
    /// curvature where there is a tangent plane. Takes some hundredths of a second per valence,
    /// once; caps themselves are made when first asked for.
    ///
    /// # Errors
    ///
    /// [`CapError`] if there are no such caps for the rings; the surface stays as it was.
    pub fn set_caps(&mut self, options: Option<CapOptions>) -> Result<(), CapError> {
        let plan = options.map(|options| CapPlan::new(&self.layout, options)).transpose()?;
        self.caps = plan.map(|plan| Caps::new(Arc::new(plan)));
        // Primvars are closed likewise.
        self.primvar_surfaces = primvar::unbuilt(&self.primvars);
        Ok(())
    }

    /// How the surface is closed, if it is.
    pub fn cap_options(&self) -> Option<CapOptions> {
        self.cap_plan().map(|plan| plan.options)
    }

    pub(crate) fn cap_plan(&self) -> Option<&Arc<CapPlan>> {
        self.caps.as_ref().map(|caps| &caps.plan)
    }

    /// The cap around an extraordinary point, by its index; `None` if rings go on for ever, or
    /// there is no such point.
    #[inline]
    pub fn cap(&self, point: usize) -> Option<&Cap<N>> {
        let caps = self.caps.as_ref()?;
        let Caps { plan, made } = caps;
        let make = || Cap::with_rules(self.rings_at(point), plan.options.rings, plan.rules(point));
        Some(made.get(point)?.get_or_init(make))
    }
}
