//! A pixel's ray tree adds up to the pixel.

use crate::common::{compiled, glass_and_mirrors, rendered};
use strahl_math::Interval;
use strahl_render::{
    BranchEnd, Intersector, RayKind, Refinement, RenderOptions, Sampling, explain,
};
use strahl_shade::Color;

#[test]
fn the_sum_of_the_tree_is_the_pixel_to_the_last_bit() {
    let scene = compiled(&glass_and_mirrors());
    for sampling in [
        Sampling::Center,
        Sampling::Corners,
        Sampling::Grid(3),
        Sampling::Adaptive(Refinement {
            threshold: 0.02,
            ..Refinement::DEFAULT
        }),
        Sampling::Recursive(Refinement {
            threshold: 0.02,
            ..Refinement::DEFAULT
        }),
    ] {
        let picture = rendered(&scene, |o| o.sampling = sampling).film;
        let options = RenderOptions {
            sampling,
            ..RenderOptions::new(&scene, 96, 64)
        };
        let mut rays = 0;
        for (x, y) in [
            (0, 0),
            (48, 32),
            (40, 30),
            (20, 35),
            (60, 40),
            (70, 44),
            (95, 63),
            (47, 20),
        ] {
            let pixel = explain(&scene, &options, x, y).expect("exists");
            assert_eq!(Some(pixel.film), picture.pixel(x, y), "{sampling} {x},{y}");
            for sample in &pixel.samples {
                let tree = &sample.tree;
                rays += tree.nodes.len();
                for node in &tree.nodes {
                    let (mut reflected, mut transmitted) = (Color::BLACK, Color::BLACK);
                    for child in &node.children {
                        let child = &tree.nodes[*child as usize];
                        match child.report.kind {
                            RayKind::Reflection => reflected = child.total,
                            _ => transmitted = child.total,
                        }
                    }
                    let mut total = node.local;
                    if let Some(hit) = &node.report.hit {
                        let mut local = hit.ambient + hit.emission;
                        for light in &node.lights {
                            local += light.term.diffuse + light.term.specular;
                            let mut terms = (Color::BLACK, Color::BLACK);
                            for term in &light.detail.terms {
                                terms.0 += term.diffuse;
                                terms.1 += term.highlight;
                            }
                            assert_eq!(terms, (light.term.diffuse, light.term.specular));
                        }
                        assert_eq!(local, node.local);
                        total = local + hit.reflection * reflected + hit.transmission * transmitted;
                    }
                    assert_eq!(total * node.report.attenuation, node.total);
                }
            }
        }
        assert!(rays > 40, "the scene has deep trees: {rays}");
    }
}

/// The centre of a pixel of an edge counts for the places that lie away from the edge.
#[test]
fn centers_stand_for_the_places_that_are_not_traced() {
    let scene = compiled(&glass_and_mirrors());
    let (mut in_part, mut whole) = (0, 0);
    for depth in [2, 3, 4, 5] {
        let sampling = Sampling::Adaptive(Refinement {
            depth,
            ..Refinement::DEFAULT
        });
        let picture = rendered(&scene, |o| o.sampling = sampling).film;
        let options = RenderOptions {
            sampling,
            ..RenderOptions::new(&scene, 96, 64)
        };
        for x in 12..84 {
            let pixel = explain(&scene, &options, x, 33).expect("exists");
            assert_eq!(Some(pixel.film), picture.pixel(x, 33), "{depth}: {x}");
            let all: u32 = pixel.samples.iter().map(|sample| sample.times).sum();
            match pixel.samples.len() {
                1 => assert_eq!(all, 1),
                traced => {
                    in_part += usize::from(traced < all as usize);
                    whole += usize::from(traced == all as usize);
                    let sum = pixel.samples.iter().fold(Color::BLACK, |sum, sample| {
                        sum + sample.color * f64::from(sample.times)
                    });
                    let error = sum / f64::from(all) - pixel.color;
                    assert!(error.map(f64::abs).max_component() < 1e-12);
                }
            }
        }
    }
    assert!(in_part > 20 && whole > 20, "{in_part} {whole}");
}

#[test]
fn branches_that_end_say_why() {
    let scene = compiled(&glass_and_mirrors());
    let mut options = RenderOptions::new(&scene, 96, 64);
    let ends = |options: &RenderOptions| {
        let pixel = explain(&scene, options, 46, 33).expect("exists");
        let nodes = pixel.samples.into_iter().flat_map(|s| s.tree.nodes);
        nodes
            .flat_map(|n| n.ended)
            .map(|(_, _, end)| end)
            .collect::<Vec<_>>()
    };
    options.trace.max_depth = 2;
    options.trace.adc_bailout = 0.0;
    assert!(ends(&options).contains(&BranchEnd::DepthLimit));
    options.trace.max_depth = 100;
    options.trace.adc_bailout = 0.5;
    assert!(ends(&options).contains(&BranchEnd::WeightCutoff));
    options.trace.adc_bailout = 0.0;
    options.trace.max_tree_rays = 50;
    assert!(ends(&options).contains(&BranchEnd::TreeLimit));
}

/// What a shadow ray reports is what it brings, and what blocks it is the nearest thing that lets nothing through.
#[test]
fn shadow_rays_tell_what_is_in_their_way() {
    let scene = compiled(&glass_and_mirrors());
    let options = RenderOptions::new(&scene, 96, 64);
    let (mut blocked, mut weakened) = (0, 0);
    for (x, y) in (0..96).step_by(5).flat_map(|x| [(x, 40), (x, 50)]) {
        let pixel = explain(&scene, &options, x, y).expect("exists");
        let nodes = pixel.samples.iter().flat_map(|s| &s.tree.nodes);
        for light in nodes.flat_map(|node| &node.lights) {
            let [shadow] = light.detail.shadows.as_slice() else {
                assert_eq!(light.term.shadow_ray, None);
                continue;
            };
            assert_eq!(shadow.visible, light.term.visible);
            let mut visible = Color::WHITE;
            for met in &shadow.met {
                visible *= met.filter;
                visible *= met.absorbed;
                blocked += u32::from(met.blocks);
                weakened += u32::from(!met.blocks);
            }
            assert_eq!(visible * shadow.rest, shadow.visible);
            if let Some(last) = shadow.met.last()
                && last.blocks
            {
                assert_eq!(shadow.met.len(), 1);
                let mut tracer = Intersector::new(&scene);
                let before = Interval::new(0.0, last.t * (1.0 - 1e-9));
                assert!(!tracer.any_opaque(&shadow.ray, before, None));
                let beyond = Interval::new(last.t * (1.0 - 1e-9), last.t * (1.0 + 1e-9));
                assert!(tracer.any_opaque(&shadow.ray, beyond, None));
            }
        }
    }
    assert!(blocked > 3 && weakened > 3, "{blocked} {weakened}");
}

#[test]
fn a_pixel_outside_of_the_picture_is_an_error() {
    let scene = compiled(&glass_and_mirrors());
    let error = explain(&scene, &RenderOptions::new(&scene, 96, 64), 96, 0).expect_err("outside");
    assert!(error.to_string().contains("96 x 64"), "{error}");
}
