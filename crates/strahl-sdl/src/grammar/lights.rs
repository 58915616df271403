use crate::grammar::entity::{has_no_surface, transform};
use crate::grammar::{Entity, Thing};
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::{Kind, Token};
use strahl_math::{DVec3, Transform, det};
use strahl_scene::{CsgOp, LightMask, Object, ObjectExt, ObjectKind, SceneLight};
use strahl_shade::{AreaLight, Color, Falloff, Light, LightKind};

/// Objects closer to a light than this cast no shadow in its light (measured with POV-Ray 3.7), so lights may lie in surfaces.
const LIGHT_CLEARANCE: f64 = 1e-3;

/// `light_source { ... }` as a statement.
pub(super) fn light_statement(p: &mut Parser<'_>) -> PResult<()> {
    let entity = light_source(p)?;
    let ObjectKind::Light(light) = entity.object.kind else {
        p.add(entity);
        return Ok(());
    };
    let moved = entity.object.transform.map(|t| light.transformed(&t));
    p.scene.lights.push(moved.unwrap_or(*light));
    Ok(())
}

/// `light_source { position colour ... }`: a light, or the union of a light and its `looks_like` object.
pub(super) fn light_source(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let name = p.peek()?;
        let named = p.accept_thing(|thing| match thing {
            Thing::Object(object) => Some(object),
            _ => None,
        })?;
        match named {
            Some(named) if is_light(&named.entity.object) => {
                return p.named_light(&named.entity.object, place).map(Entity::from);
            }
            // A declared object may be in the braces of any object.
            Some(named) => {
                let mut entity = p.declared_object(&named, name, place);
                p.modifiers(&mut entity)?;
                return Ok(entity);
            }
            None => {}
        }
        let mut draft = Draft::at(p.vector3()?);
        p.comma()?;
        p.items("`light_source`", |p, token| p.light_item(&mut draft, token))?;
        Ok(p.finish_light(draft, place).into())
    })
}

/// `light_group { lights and objects }`: the lights illuminate only these objects.
pub(super) fn light_group(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.braces(|p| {
        let mut parts = vec![];
        let mut global_lights = false;
        loop {
            if p.accept_word(Word::GlobalLights)? {
                global_lights = p.switched()?;
                continue;
            }
            let token = p.peek()?;
            let may_be_lamp = token.is(Word::LightSource) || token.kind == Kind::Name;
            match p.object()? {
                Some(lamp) if may_be_lamp && is_light(&lamp) => add_lamp(lamp, &mut parts),
                Some(object) => parts.push(object),
                None => break,
            }
        }
        parts.retain(|part| !has_no_surface(part));
        let op = CsgOp::LightGroup {
            global_lights,
            outer_lights: false,
        };
        let mut entity = Entity::from(Object::csg(op, parts));
        entity.object.span = p.span_at(place);
        p.modifiers(&mut entity)?;
        Ok(entity)
    })
}

/// Adds a light, and its `looks_like` object as a separate part, because the light itself must be a direct part of the group.
fn add_lamp(mut lamp: Object, parts: &mut Vec<Object>) {
    match &mut lamp.kind {
        ObjectKind::Csg { children, .. } => {
            let map = lamp.transform.as_deref().copied().unwrap_or_default();
            let children = std::mem::take(&mut children.0);
            parts.extend(children.into_iter().map(|part| part.transformed(&map)));
        }
        _ => parts.push(lamp),
    }
}

/// Whether an object is a light, alone or with its `looks_like` object.
fn is_light(object: &Object) -> bool {
    match &object.kind {
        ObjectKind::Light(_) => true,
        ObjectKind::Csg {
            op: CsgOp::Union,
            children,
        } => matches!(
            children.0.first().map(|o| &o.kind),
            Some(ObjectKind::Light(_))
        ),
        _ => false,
    }
}

/// The shape of the light: cone, beam or plane.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Point,
    Spot,
    Cylinder,
}

/// A light being read. A transformation applies to the items before it.
struct Draft {
    form: Form,
    parallel: bool,
    position: DVec3,
    point_at: DVec3,
    color: [f64; 5],
    radius: Option<f64>,
    falloff: Option<f64>,
    tightness: f64,
    fade_distance: f64,
    fade_power: f64,
    shadowless: bool,
    fogged: bool,
    area: Option<AreaLight>,
    looks_like: Option<Object>,
    /// The object that the light must pass through.
    projected_through: Option<Object>,
}

impl Draft {
    fn at(position: DVec3) -> Self {
        Self {
            form: Form::Point,
            parallel: false,
            position,
            point_at: DVec3::Z,
            color: [0.0; 5],
            radius: None,
            falloff: None,
            tightness: 0.0,
            fade_distance: 0.0,
            fade_power: 0.0,
            shadowless: false,
            fogged: false,
            area: None,
            looks_like: None,
            projected_through: None,
        }
    }

    fn transform(&mut self, t: &Transform) {
        self.position = t.point_to_world(self.position);
        self.point_at = t.point_to_world(self.point_at);
        if let Some(area) = &mut self.area {
            area.axis_1 = t.vector_to_world(area.axis_1);
            area.axis_2 = t.vector_to_world(area.axis_2);
        }
        let objects = [&mut self.looks_like, &mut self.projected_through];
        for object in objects.into_iter().flatten() {
            transform(object, t);
        }
    }

    /// The options of an area light may precede `area_light`; they have an effect only with it.
    fn area(&mut self) -> &mut AreaLight {
        self.area
            .get_or_insert(AreaLight::new(DVec3::ZERO, DVec3::ZERO, 1, 1))
    }

    fn kind(&self) -> LightKind {
        let position = self.position;
        let direction = (self.point_at - position).normalize_or_zero();
        let radians = |degrees: f64| det::cos(degrees.to_radians());
        match self.form {
            _ if direction == DVec3::ZERO => LightKind::Point { position },
            Form::Cylinder => {
                let outer = self.falloff.unwrap_or(1.0);
                let inner = self.radius.unwrap_or(0.75);
                // The beam ends at its falloff, sharply if its radius is larger or none (measured).
                let is_soft = inner > 0.0 && inner < outer;
                LightKind::Beam {
                    position,
                    direction,
                    inner: if is_soft { inner } else { outer },
                    outer,
                    tightness: self.tightness,
                }
            }
            // For a parallel light, every point in front of its plane is in the middle of the cone. As in POV-Ray (measured) light without
            // shadows and that of no cone is behind the plane too.
            Form::Spot if self.parallel && !self.shadowless => LightKind::Beam {
                position,
                direction,
                inner: f64::INFINITY,
                outer: f64::INFINITY,
                tightness: 0.0,
            },
            _ if self.parallel => LightKind::Parallel {
                position,
                direction,
            },
            Form::Spot => LightKind::Spot {
                position,
                direction,
                cos_inner: radians(self.radius.unwrap_or(30.0)),
                cos_outer: radians(self.falloff.unwrap_or(45.0)),
                tightness: self.tightness,
            },
            Form::Point => LightKind::Point { position },
        }
    }
}

impl Parser<'_> {
    /// Items after a declared light: transformations move it as a whole, other items are allowed only in its declaration.
    fn named_light(&mut self, named: &Object, place: Place) -> PResult<Object> {
        let mut object = named.clone();
        object.span = self.span_at(place);
        self.items("`light_source`", |p, token| {
            match p.transformation(token)? {
                Some(t) => {
                    let moved = std::mem::replace(&mut object, Object::csg(CsgOp::Union, vec![]));
                    object = moved.transformed(&t);
                    Ok(())
                }
                None => p.skip_item(token, "a declared light"),
            }
        })?;
        if object.transform.is_none()
            && let ObjectKind::Light(light) = &mut object.kind
        {
            light.span = object.span;
        }
        Ok(object)
    }

    fn light_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        if let Some(transform) = self.transformation(token)? {
            draft.transform(&transform);
            return Ok(());
        }
        let Some(word) = token.word() else {
            draft.color = self.color()?;
            return Ok(());
        };
        if word.kind() == crate::keywords::WordKind::Color {
            draft.color = self.color()?;
            return Ok(());
        }
        match word {
            Word::Spotlight | Word::Cylinder | Word::Parallel | Word::Shadowless => {
                self.take(token)?;
                // Of spotlight, cylinder and shadowless the last keyword counts, but the light of a cylinder stays
                // parallel (measured).
                (draft.form, draft.shadowless) = match word {
                    Word::Spotlight => (Form::Spot, false),
                    Word::Cylinder => {
                        draft.parallel = true;
                        (Form::Cylinder, false)
                    }
                    Word::Shadowless => (Form::Point, true),
                    _ => {
                        draft.parallel = true;
                        (draft.form, draft.shadowless)
                    }
                };
            }
            Word::PointAt => {
                self.take(token)?;
                draft.point_at = self.vector3()?;
            }
            Word::Radius
            | Word::Falloff
            | Word::Tightness
            | Word::FadeDistance
            | Word::FadePower => {
                self.take(token)?;
                let value = self.float()?;
                match word {
                    Word::Radius => draft.radius = Some(value),
                    Word::Falloff => draft.falloff = Some(value),
                    Word::Tightness => draft.tightness = value,
                    Word::FadeDistance => draft.fade_distance = value,
                    _ => draft.fade_power = value,
                }
            }
            Word::LooksLike => {
                self.take(token)?;
                draft.looks_like = Some(self.looks_like()?.translated(draft.position));
            }
            // There are no scattering media that could interact with the light.
            Word::MediaInteraction => {
                self.take(token)?;
                self.switched()?;
            }
            Word::MediaAttenuation => {
                self.take(token)?;
                draft.fogged = self.switched()?;
            }
            Word::ProjectedThrough => {
                self.take(token)?;
                let mut object = super::objects::object(self)?.object;
                self.expand_instances(&mut object)?;
                draft.projected_through = Some(object);
            }
            _ => return self.area_item(draft, token, word),
        }
        Ok(())
    }

    fn area_item(&mut self, draft: &mut Draft, token: Token, word: Word) -> PResult<()> {
        match word {
            Word::AreaLight => {
                self.take(token)?;
                let axis_1 = self.vector3()?;
                self.comma()?;
                let axis_2 = self.vector3()?;
                self.comma()?;
                let size_1 = self.area_size()?;
                self.comma()?;
                let size_2 = self.area_size()?;
                let area = draft.area();
                (area.axis_1, area.axis_2) = (axis_1, axis_2);
                (area.size_1, area.size_2) = (size_1, size_2);
            }
            Word::Adaptive => {
                self.take(token)?;
                let level = self.float()?;
                // The cast saturates; no grid can be divided more than 32 times.
                draft.area().adaptive = Some((level as u32).min(32));
            }
            Word::Jitter => {
                self.take(token)?;
                draft.area().jitter = true;
            }
            Word::Circular => {
                self.take(token)?;
                draft.area().circular = true;
            }
            Word::Orient => {
                self.take(token)?;
                // As in POV-Ray (measured) such a light is circular, too.
                (draft.area().orient, draft.area().circular) = (true, true);
            }
            Word::AreaIllumination => {
                self.take(token)?;
                draft.area().illumination = self.switched()?;
            }
            _ => return self.skip_item(token, "`light_source`"),
        }
        Ok(())
    }

    fn area_size(&mut self) -> PResult<u32> {
        let size = self.float()?;
        let most = AreaLight::MAX_SIZE;
        if size >= 1.0 && size < f64::from(most) + 1.0 {
            return Ok(size as u32);
        }
        let place = self.place();
        Err(self.fail(
            place,
            format!("an area light has 1 to {most} points along an edge, not {size}"),
        ))
    }

    /// `{ object }` after `looks_like`; it casts no shadow.
    fn looks_like(&mut self) -> PResult<Object> {
        let mut object = super::objects::object(self)?.object;
        object.visibility.shadow = false;
        object.is_lamp = true;
        Ok(object)
    }

    fn finish_light(&mut self, draft: Draft, place: Place) -> Object {
        let span = self.span_at(place);
        let kind = draft.kind();
        if draft.form != Form::Point && matches!(kind, LightKind::Point { .. }) {
            self.warn(
                place,
                "the light points at its own location, so it shines in all directions",
            );
        }
        let [r, g, b, ..] = draft.color;
        let mut light = Light::new(kind, Color::new(r, g, b));
        light.casts_shadows = !draft.shadowless;
        light.highlights = !draft.shadowless;
        light.fogged = draft.fogged;
        light.clearance = LIGHT_CLEARANCE;
        if draft.fade_distance > 0.0 && draft.fade_power > 0.0 {
            light.falloff = Falloff::Fade {
                distance: draft.fade_distance,
                power: draft.fade_power,
            };
        }
        // A grid of a single point has no area.
        light.area = draft.area.filter(|a| a.size_1 > 1 || a.size_2 > 1);
        if let Some(area) = &mut light.area {
            let reach = (draft.point_at - draft.position).length();
            area.reach = if reach > 0.0 { reach } else { 1.0 };
        }
        let mask = draft.projected_through.map(|object| {
            let group = self.scene.add_group(vec![object]);
            let transform = Transform::IDENTITY;
            Box::new(LightMask { group, transform })
        });
        let object = Object::light(SceneLight {
            light,
            mask,
            name: None,
            span,
        });
        let object = match draft.looks_like {
            None => object,
            Some(looks) => Object::csg(CsgOp::Union, vec![object, looks]),
        };
        object.spanned(span)
    }
}
