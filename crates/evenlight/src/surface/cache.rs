//! Rules that surfaces share: to make them takes longer than the rest of a small surface.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::{PointRule, SurfaceOptions};
use crate::cap::{CapError, CapKind, ValenceCap};
use crate::mesh::Fan;
use crate::rings::ValenceRules;
use crate::scheme::{Contraction, RuleSet, SchemeKind, Variant};

/// The rules around points of one kind, and those of their caps.
#[derive(Debug)]
pub(crate) struct SharedRules {
    rules: Arc<ValenceRules>,
    /// By the number of the kind.
    caps: [OnceLock<Result<Arc<ValenceCap>, CapError>>; CapKind::ALL.len() + 1],
}

impl SharedRules {
    fn new(rules: ValenceRules) -> Self {
        Self { rules: Arc::new(rules), caps: [const { OnceLock::new() }; CapKind::ALL.len() + 1] }
    }

    pub(crate) fn rules(&self) -> &Arc<ValenceRules> {
        &self.rules
    }

    /// The rules of caps, made when they are first asked for.
    pub(crate) fn cap(&self, kind: CapKind) -> Result<Arc<ValenceCap>, CapError> {
        let make = || ValenceCap::new(&self.rules, kind).map(Arc::new);
        self.caps[kind as usize].get_or_init(make).clone()
    }
}

/// Rules around extraordinary points and of their caps, made once for all surfaces that are built
/// with the same cache.
///
/// [`Surface::build`](super::Surface::build) takes one that the whole process shares. A host that
/// wants to free the memory, or to keep its own apart, makes one and hands it to
/// [`Layout::with_cache`](super::Layout::with_cache). Clones are the same cache.
///
/// When it is full, what was not used for the longest time is dropped; surfaces keep the rules that
/// they have.
///
/// ```
/// use evenlight::surface::{Layout, RuleCache};
/// use evenlight::{Cage, Mesh, SurfaceOptions};
///
/// let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
/// let sides =
///     [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// let cage = Cage::new(Mesh::new((0..8).map(corner).collect(), sides))?;
/// let cache = RuleCache::default();
/// Layout::with_cache(&cage, SurfaceOptions::default(), &cache)?;
/// assert_eq!(cache.len(), 1, "all corners have valence 3");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RuleCache {
    capacity: usize,
    kept: Arc<Mutex<Kept>>,
}

#[derive(Debug, Default)]
struct Kept {
    /// The rules, their size and when they were last used.
    entries: BTreeMap<Key, Entry>,
    /// The weights of all entries.
    weights: usize,
    /// Counts the uses.
    clock: u64,
}

#[derive(Debug)]
struct Entry {
    rules: Arc<SharedRules>,
    weights: usize,
    last_use: u64,
}

/// What rules depend on, and nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    /// A scheme at a valence. A contraction is the number of its kind and the bits of lambda.
    Scheme {
        scheme: SchemeKind,
        rules: RuleSet,
        contraction: (u8, u64),
        valence: usize,
    },
    Fan(Fan),
    FairFan(Fan),
}

/// 128 MB of weights.
const DEFAULT_CAPACITY: usize = 8 << 20;

impl Default for RuleCache {
    /// A cache of its own that holds 8 million weights, some 128 MB.
    fn default() -> Self {
        Self::with_capacity(DEFAULT_CAPACITY)
    }
}

impl RuleCache {
    /// A cache of its own that holds rules of up to this number of weights, of 16 bytes each. It
    /// always holds the rules that were asked for last, however large they are.
    pub fn with_capacity(weights: usize) -> Self {
        Self { capacity: weights, kept: Arc::default() }
    }

    /// The cache of the process.
    pub fn global() -> Self {
        static GLOBAL: OnceLock<RuleCache> = OnceLock::new();
        GLOBAL.get_or_init(Self::default).clone()
    }

    /// How many rules it holds: of valences, or fans between creases.
    pub fn len(&self) -> usize {
        self.lock().entries.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Drops everything.
    pub fn clear(&self) {
        *self.lock() = Kept::default();
    }

    fn lock(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The rules of a fan that has this rule. There must be some: [`PointRule::of`] asks before,
    /// and Catmull-Clark has all.
    pub(super) fn rules(
        &self,
        rule: PointRule,
        fan: Fan,
        options: SurfaceOptions,
    ) -> Option<Arc<SharedRules>> {
        let key = Key::new(rule, fan, options);
        if let Some(rules) = self.lock().used(key) {
            return Some(rules);
        }
        // Not under the lock: others need not wait for what takes long.
        let rules = key.make(options)?;
        let weights = rules.num_weights();
        let mut kept = self.lock();
        kept.insert(key, Arc::new(SharedRules::new(rules)), weights);
        kept.shrink_to(self.capacity, key);
        kept.used(key)
    }
}

impl Kept {
    fn used(&mut self, key: Key) -> Option<Arc<SharedRules>> {
        self.clock += 1;
        let entry = self.entries.get_mut(&key)?;
        entry.last_use = self.clock;
        Some(entry.rules.clone())
    }

    /// Adds rules, unless another thread was faster.
    fn insert(&mut self, key: Key, rules: Arc<SharedRules>, weights: usize) {
        let last_use = self.clock;
        self.entries.entry(key).or_insert_with(|| {
            self.weights += weights;
            Entry { rules, weights, last_use }
        });
    }

    /// Drops what was not used for the longest time, but not `newest`, until the rest fits.
    fn shrink_to(&mut self, capacity: usize, newest: Key) {
        while self.weights > capacity {
            let others = self.entries.iter().filter(|&(&key, _)| key != newest);
            let oldest = others.min_by_key(|(_, entry)| entry.last_use).map(|(&key, _)| key);
            let Some(entry) = oldest.and_then(|key| self.entries.remove(&key)) else { return };
            self.weights -= entry.weights;
        }
    }
}

impl Key {
    fn new(rule: PointRule, fan: Fan, options: SurfaceOptions) -> Self {
        let of_scheme = |scheme, Variant { rules, contraction }| {
            let contraction = match contraction {
                Contraction::CatmullClark => (0, 0),
                Contraction::Half => (1, 0),
                Contraction::Lambda(lambda) => (2, lambda.to_bits()),
            };
            Self::Scheme { scheme, rules, contraction, valence: fan.faces }
        };
        match rule {
            PointRule::FairCrease(_) => Self::FairFan(fan),
            PointRule::CatmullClark(_) if !fan.is_smooth() => Self::Fan(fan),
            PointRule::CatmullClark(_) => of_scheme(SchemeKind::CatmullClark, Variant::default()),
            PointRule::Scheme => of_scheme(options.scheme, options.variant()),
        }
    }

    fn make(self, options: SurfaceOptions) -> Option<ValenceRules> {
        match self {
            Self::FairFan(fan) => ValenceRules::of_fair_fan(fan),
            Self::Fan(fan) => Some(ValenceRules::of_fan(fan)),
            Self::Scheme { scheme, valence, .. } => {
                let is_chosen = scheme == options.scheme;
                let variant = if is_chosen { options.variant() } else { Variant::default() };
                ValenceRules::new(scheme, variant, valence)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::VertexRule;

    fn smooth(faces: usize) -> Fan {
        Fan { faces, is_closed: true, has_dart: false, rule: VertexRule::Smooth }
    }

    fn ask(cache: &RuleCache, faces: usize) -> Arc<SharedRules> {
        cache.rules(PointRule::Scheme, smooth(faces), SurfaceOptions::default()).unwrap()
    }

    #[test]
    fn rules_are_made_once() {
        let cache = RuleCache::default();
        assert!(Arc::ptr_eq(&ask(&cache, 5), &ask(&cache.clone(), 5)));
        assert!(!Arc::ptr_eq(&ask(&cache, 5), &ask(&RuleCache::default(), 5)));
        let options = SurfaceOptions {
            creases: crate::surface::CreaseRings::Fair,
            ..SurfaceOptions::default()
        };
        cache.rules(PointRule::Scheme, smooth(5), options).unwrap();
        assert_eq!(cache.len(), 1, "they do not depend on the rings beside creases");
    }

    #[test]
    fn a_full_cache_drops_the_oldest_and_keeps_the_newest() {
        let cache = RuleCache::with_capacity(ask(&RuleCache::default(), 16).rules().num_weights());
        let oldest = ask(&cache, 3);
        for faces in 5..=16 {
            let rules = ask(&cache, faces);
            assert!(Arc::ptr_eq(&rules, &ask(&cache, faces)), "the newest is always there");
        }
        assert!(!Arc::ptr_eq(&oldest, &ask(&cache, 3)));
        let few = RuleCache::with_capacity(0);
        ask(&few, 5);
        assert_eq!(few.len(), 1);
        few.clear();
        assert!(few.is_empty());
    }
}
