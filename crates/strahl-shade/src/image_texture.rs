//! stub
use strahl_math::DVec2;
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrap {
    Repeat,
}
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    Nearest,
}
#[derive(Clone, Debug, PartialEq)]
pub struct TextureImage {}
impl TextureImage {
    pub fn sample(&self, _uv: DVec2, _u: Wrap, _v: Wrap, _f: Filter) -> [f64; 4] {
        [1.0; 4]
    }
}
