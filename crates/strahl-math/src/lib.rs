//! The ground everything in strahl stands on: rays, intervals, boxes, transforms, the one home of error bounds, and
//! deterministic elementary functions.
//!
//! Everything that decides what a pixel looks like uses only operations IEEE 754 rounds correctly (`+ - * /`, square
//! root, comparisons) or the software functions of [`det`]. The same scene therefore gives the same bits on every
//! machine, with every compiler flag.

mod aabb;
pub mod decimal;
pub mod det;
pub mod error;
mod interval;
pub mod noise;
mod ray;
pub mod roots;
mod transform;

pub use aabb::Aabb;
pub use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, DVec4, Mat4, Vec4, Vec4Swizzles};
pub use interval::Interval;
pub use ray::Ray;
pub use transform::{SingularTransform, Transform};
