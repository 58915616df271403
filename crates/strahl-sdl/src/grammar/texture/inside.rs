use crate::grammar::query::Query;
use std::sync::Arc;
use strahl_function::Cost;
use strahl_math::DVec3;
use strahl_scene::Object;
use strahl_shade::patterns::Inside;

/// The inside of an object, for the object pattern. Empty objects, and instances of groups, have none.
pub fn inside(object: &Object) -> Arc<dyn Inside> {
    Arc::new(ObjectInside(Query::new(object).map(Arc::new)))
}

/// An object for the object pattern; an empty one has no inside.
#[derive(Debug)]
pub(super) struct ObjectInside(pub(super) Option<Arc<Query>>);

impl Inside for ObjectInside {
    fn contains(&self, p: DVec3) -> bool {
        self.0.as_ref().is_some_and(|query| query.contains(p))
    }

    fn cost(&self) -> Cost {
        let cost = self.0.as_ref().map(|query| query.cost());
        cost.unwrap_or(Cost::FORMULA)
    }
}
