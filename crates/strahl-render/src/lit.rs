//! Which lights shine on an element.

use crate::light_sets::Lit;
use crate::prim::PrimKind;
use crate::scene::RenderScene;

impl RenderScene {
    /// Whether not all lights shine on everything.
    #[inline]
    pub(crate) fn has_light_groups(&self) -> bool {
        self.light_sets.has_groups()
    }

    /// The numbers of the lights of a set; `None` if these are all lights.
    #[inline]
    pub(crate) fn lights_in(&self, set: u32) -> Option<&[u32]> {
        self.light_sets.lights_in(set)
    }

    /// How an element of this object is lit.
    #[inline]
    pub(crate) fn lit(&self, element: u64, object: u32) -> Lit {
        if self.light_sets.are_special() {
            self.lit_specially(element, object)
        } else {
            Lit::DEFAULT
        }
    }

    /// The lighting of an instance in a light group overrides that of its elements.
    #[cold]
    fn lit_specially(&self, element: u64, object: u32) -> Lit {
        let own = self.light_sets.of_object(object);
        let mut around = Lit::DEFAULT;
        let (mut group, mut rest) = (&self.groups[0], element);
        loop {
            let prim = group.prim_of(rest);
            let (outer, next) = match group.prims.at(prim).kind() {
                PrimKind::Instance(index) => {
                    let instance = &group.instances[index as usize];
                    (instance.lit, Some(instance.group))
                }
                _ => (own, None),
            };
            around.both_sides |= outer.both_sides;
            if around.set == Lit::DEFAULT.set {
                around.set = outer.set;
            }
            let Some(next) = next else {
                return around;
            };
            rest -= group.first_id(prim);
            group = &self.groups[next as usize];
        }
    }
}
