use strahl_scene::CsgOp;

/// How an object is lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Lit {
    /// The set of lights that shine on it; set 0 has the lights that are in no group.
    pub(crate) set: u32,
    /// Whether light from behind counts too.
    pub(crate) both_sides: bool,
}

impl Lit {
    /// By the lights in no group, from the front: the ordinary case.
    pub(crate) const DEFAULT: Self = Self {
        set: 0,
        both_sides: false,
    };
}

/// Which lights shine on which objects, as light groups ([`CsgOp::LightGroup`]) decide: one list of lights for all objects with
/// the same lights.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightSets {
    /// Numbers of the scene's lights, by set; empty in a scene without groups, where all lights shine on everything.
    lists: Vec<Vec<u32>>,
    /// How the objects are lit; those beyond the list are [`Lit::DEFAULT`].
    of_objects: Vec<Lit>,
    /// Whether an object is not [`Lit::DEFAULT`].
    special: bool,
}

impl LightSets {
    /// Whether not all lights shine on everything.
    #[inline]
    pub(crate) fn has_groups(&self) -> bool {
        !self.lists.is_empty()
    }

    /// The numbers of the lights of a set; `None` if these are all lights.
    #[inline]
    pub(crate) fn lights_in(&self, set: u32) -> Option<&[u32]> {
        if self.lists.is_empty() {
            return None;
        }
        let list = self.lists.get(set as usize);
        Some(list.map_or(&[], Vec::as_slice))
    }

    /// Whether an object is not [`Lit::DEFAULT`].
    #[inline]
    pub(crate) const fn are_special(&self) -> bool {
        self.special
    }

    /// How an object is lit.
    pub(crate) fn of_object(&self, object: u32) -> Lit {
        let own = self.of_objects.get(object as usize);
        own.copied().unwrap_or(Lit::DEFAULT)
    }
}

/// The sets, while the scene is flattened.
#[derive(Debug, Default)]
pub(crate) struct LightSetsDraft {
    /// The groups found so far; the set of the first is 1.
    groups: Vec<GroupDraft>,
    of_objects: Vec<Lit>,
    special: bool,
}

#[derive(Debug, Default)]
struct GroupDraft {
    global_lights: bool,
    /// The set of the group around it, and whether the lights of that one shine on its objects too.
    outer: u32,
    outer_lights: bool,
    /// Numbers of its own lights among those found in objects.
    lights: Vec<u32>,
    /// Whether it has objects that are not bodies of its lights.
    has_objects: bool,
    /// The set of the bodies of its lights.
    lamps: Option<u32>,
    /// The set of the group whose lights' bodies these are.
    lamps_of: Option<u32>,
}

impl LightSetsDraft {
    /// A new set for a group with this operation, whose parent has the set `outer`.
    pub(crate) fn open(&mut self, op: CsgOp, outer: u32) -> u32 {
        let global_lights = match (self.group(outer), op) {
            (Some(outer), _) => outer.global_lights,
            (None, CsgOp::LightGroup { global_lights, .. }) => global_lights,
            (None, _) => true,
        };
        let outer_lights = matches!(
            op,
            CsgOp::LightGroup {
                outer_lights: true,
                ..
            }
        );
        self.groups.push(GroupDraft {
            global_lights,
            outer,
            outer_lights,
            ..GroupDraft::default()
        });
        self.groups.len() as u32
    }

    /// The set of the bodies that the lights of a group have. As in POV-Ray (measured) the lights outside shine on them whether the
    /// group has `global_lights` or not, and the lights of the group only if there are objects in it.
    pub(crate) fn of_lamps(&mut self, set: u32) -> u32 {
        let next = self.groups.len() as u32 + 1;
        let Some(group) = self.group(set) else {
            return set;
        };
        if let Some(lamps) = group.lamps {
            return lamps;
        }
        group.lamps = Some(next);
        self.groups.push(GroupDraft {
            global_lights: true,
            lamps_of: Some(set),
            ..GroupDraft::default()
        });
        next
    }

    fn group(&mut self, set: u32) -> Option<&mut GroupDraft> {
        self.groups.get_mut((set as usize).checked_sub(1)?)
    }

    /// Puts a light into the group of a set.
    pub(crate) fn add_light(&mut self, set: u32, light: usize) {
        if let Some(group) = self.group(set) {
            group.lights.push(light as u32);
        }
    }

    /// Sets how an object is lit; objects come in the order of their numbers.
    pub(crate) fn add_object(&mut self, lit: Lit, object: u32) {
        if let Some(group) = self.group(lit.set) {
            group.has_objects = true;
        }
        if lit != Lit::DEFAULT {
            self.of_objects.resize(object as usize, Lit::DEFAULT);
            self.of_objects.push(lit);
            self.special = true;
        }
    }

    /// Takes note of how an instance is lit.
    pub(crate) fn add_instance(&mut self, lit: Lit) {
        if let Some(group) = self.group(lit.set) {
            group.has_objects = true;
        }
        self.special |= lit != Lit::DEFAULT;
    }

    /// The group around a group.
    fn around(&self, group: &GroupDraft) -> Option<&GroupDraft> {
        self.groups.get((group.outer as usize).checked_sub(1)?)
    }

    /// The group, or the nearest one around it that has lights.
    fn lit_group<'a>(&'a self, group: &'a GroupDraft) -> Option<&'a GroupDraft> {
        std::iter::successors(Some(group), |group| self.around(group))
            .find(|g| !g.lights.is_empty())
    }

    /// The finished lists, for a scene with `before` lights of its own, followed by `found` lights among the objects.
    pub(crate) fn finished(self, before: usize, found: usize) -> LightSets {
        if self.groups.is_empty() {
            return LightSets {
                lists: vec![],
                of_objects: self.of_objects,
                special: self.special,
            };
        }
        let before = before as u32;
        let mut in_group = vec![false; found];
        for light in self.groups.iter().flat_map(|g| &g.lights) {
            in_group[*light as usize] = true;
        }
        let outside = (0..found as u32).filter(|light| !in_group[*light as usize]);
        let common: Vec<u32> = (0..before).chain(outside.map(|l| l + before)).collect();
        let of_group = |group: &GroupDraft| {
            let mut list = if group.global_lights {
                common.clone()
            } else {
                vec![]
            };
            let shining = match group.lamps_of.map(|set| &self.groups[set as usize - 1]) {
                None if group.lights.is_empty() => [self.lit_group(group), None],
                None => {
                    let around = self.around(group).filter(|_| group.outer_lights);
                    [
                        Some(group),
                        around.and_then(|around| self.lit_group(around)),
                    ]
                }
                Some(around) => [around.has_objects.then_some(around), None],
            };
            let lights = shining
                .into_iter()
                .flatten()
                .flat_map(|group| &group.lights);
            list.extend(lights.map(|light| light + before));
            list
        };
        let of_groups: Vec<Vec<u32>> = self.groups.iter().map(of_group).collect();
        LightSets {
            lists: std::iter::once(common).chain(of_groups).collect(),
            of_objects: self.of_objects,
            special: true,
        }
    }
}
