//! Every accelerator gives the answers of the list, to the last bit.
//!
//! The primitives are boxes, hit exactly by f64 slabs: the hardest shapes for conservative culling, because every hit lies on a
//! plane that the culling tests compare with. Spheres inside of the boxes check it with shapes that only touch them.

mod agreement;
mod hits;
mod names;
mod packets;
mod scenes;
mod trees;
mod way;

use strahl_accel::AcceleratorKind;

/// Every structure, with every parameter that changes how it is built or traversed.
pub(crate) fn kinds() -> Vec<AcceleratorKind> {
    let variants = [
        "bvh:compact",
        "bvh:build=fast",
        "bvh:build=high",
        "spheres:build=agglomerative",
        "grid:density=1",
        "grid:resolution=3x20x7",
        "grid:havran,density=10",
        "grids:density=1",
        "octree:split=centre,leaf=1",
        "octree:traversal=exit-face",
        "octree:traversal=trial-plane",
        "octree:traversal=neighbours",
        "octree:split=centre,traversal=trial-plane",
        "octree:split=centre,traversal=neighbours",
        "octree:havran,depth=5",
    ];
    let parsed = variants.iter().map(|v| v.parse().expect("an accelerator"));
    AcceleratorKind::ALL.iter().copied().chain(parsed).collect()
}
