//! Accelerators and their parameters as text.

use crate::kinds;
use strahl_accel::AcceleratorKind;

#[test]
fn unknown_names_are_answered_with_all_names() {
    let error = "kdtree"
        .parse::<AcceleratorKind>()
        .expect_err("unknown")
        .to_string();
    for kind in AcceleratorKind::ALL {
        assert!(error.contains(kind.name()));
    }
    for kind in kinds() {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
}

#[test]
fn wrong_parameters_are_answered_with_those_there_are() {
    for (text, parts) in [
        (
            "grid:depth=3",
            ["no parameter `depth`", "density=NUMBER", "havran"],
        ),
        (
            "grid:density=0",
            ["expected `density=NUMBER`", "density=0", "grid"],
        ),
        ("grid:resolution=3x4", ["resolution=XxYxZ", "found", "grid"]),
        ("grid:havran=1", ["expected `havran`", "havran=1", "grid"]),
        (
            "octree:split=middle",
            ["split=cost|centre", "split=middle", "octree"],
        ),
        ("octree:depth=21", ["depth=0..20", "depth=21", "octree"]),
        (
            "spheres:build",
            ["build=bvh|agglomerative", "found `build`", "spheres"],
        ),
        (
            "bvh:simd=mmx",
            ["simd=scalar|sse4|avx2|avx512", "simd=mmx", "bvh"],
        ),
        ("bvh:compact=1", ["expected `compact`", "compact=1", "bvh"]),
        (
            "bvh:build=slow",
            ["build=default|fast|high", "build=slow", "bvh"],
        ),
        ("list:fast", ["`list` has no parameters", "fast", "list"]),
    ] {
        let error = text.parse::<AcceleratorKind>().expect_err(text).to_string();
        for part in parts {
            assert!(error.contains(part), "{text}: {error}");
        }
    }
    let spaced = "octree: depth = 7 , split=centre".parse::<AcceleratorKind>();
    assert_eq!(
        spaced.expect("fine").to_string(),
        "octree:depth=7,split=centre"
    );
}
