use super::Texture;
use crate::parser::Parser;
use std::sync::Arc;
use strahl_shade::{Color, Finish, Material, ShadingModel};

impl Texture {
    /// The texture in the engine's terms: colour times coefficients.
    fn to_material(&self) -> Material {
        let [r, g, b, filter, transmit] = self.pigment.color;
        let color = Color::new(r, g, b);
        let f = &self.finish;
        let phong = f.phong > 0.0 && f.specular <= 0.0;
        let (strength, shininess) = if phong {
            (f.phong, f.phong_size)
        } else {
            (f.specular, 1.0 / f.roughness)
        };
        let model = if phong {
            ShadingModel::Phong
        } else {
            ShadingModel::BlinnPhong
        };
        let finish = Finish {
            ambient: color * Color::from(f.ambient),
            diffuse: color * f.diffuse,
            specular: Color::gray(strength),
            shininess,
            reflection: Color::from(f.reflection),
            emission: color * Color::from(f.emission),
            ..Finish::BLACK
        };
        Material {
            model: Some(model),
            finish,
            ..Material::matte(color)
        }
        .with_transparency(color, filter, transmit)
    }
}

impl Parser<'_> {
    /// The material of a texture; equal textures one after the other share it.
    pub(in crate::grammar) fn material(&mut self, texture: &Texture) -> Arc<Material> {
        if let Some((last, material)) = &self.state.last_material
            && last == texture
        {
            return Arc::clone(material);
        }
        let material = Arc::new(texture.to_material());
        self.state.last_material = Some((texture.clone(), Arc::clone(&material)));
        material
    }
}
