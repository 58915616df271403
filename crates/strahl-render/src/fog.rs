use crate::scene::RenderScene;
use strahl_math::Ray;
use strahl_shade::Color;

impl RenderScene {
    /// What of the light from the far end of a ray of this length (in world units) passes the scene's fogs, and what they
    /// add. As in POV-Ray fogs don't weaken each other's colours.
    #[cold]
    pub(crate) fn fog_along(&self, ray: &Ray, length: f64) -> (Color, Color) {
        let direction = ray.direction.normalize_or_zero();
        let (mut keeps, mut adds) = (Color::WHITE, Color::BLACK);
        for fog in &self.fogs {
            let depth = fog.depth(ray.origin, direction, length);
            let (kept, added) = fog.at_depth(depth);
            adds += added;
            keeps *= kept;
        }
        (keeps, adds)
    }
}
