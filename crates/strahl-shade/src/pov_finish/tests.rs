//! Values measured with POV-Ray 3.7.0.10: pixels of a unit sphere of colour <0.8, 0.5, 0.3> seen from -z, lit with
//! strength 0.7 from <1000, 2000, -1500>.

use super::*;

const PIGMENT: Color = Color::new(0.8, 0.5, 0.3);
const LIGHT: f64 = 0.7;

/// Points of the sphere.
const NORMALS: [[f64; 3]; 4] = [
    [
        -0.20833333333333337,
        0.5416666666666667,
        -0.8143675119038359,
    ],
    [
        0.29166666666666674,
        0.20833333333333337,
        -0.9335565209336699,
    ],
    [
        0.04166666666666674,
        -0.04166666666666674,
        -0.9982623792259117,
    ],
    [
        -0.5416666666666667,
        -0.20833333333333326,
        -0.8143675119038359,
    ],
];

fn dull() -> PovFinish {
    PovFinish {
        ambient: Color::BLACK,
        diffuse: 0.0,
        ..PovFinish::default()
    }
}

#[test]
fn shades_a_sphere_as_measured() {
    let cases: [(PovFinish, [[f64; 3]; 4]); 7] = [
        (
            PovFinish {
                diffuse: 0.6,
                ..dull()
            },
            [
                [0.26157, 0.163485, 0.098085],
                [0.263081, 0.164431, 0.098665],
                [0.181567, 0.113481, 0.068086],
                [0.032715, 0.020447, 0.012268],
            ],
        ),
        (
            PovFinish {
                diffuse: 0.6,
                brilliance: 3.0,
                ..dull()
            },
            [
                [0.158526, 0.099077, 0.059449],
                [0.161288, 0.100801, 0.060487],
                [0.053025, 0.033143, 0.019883],
                [0.000305, 0.000198, 0.000122],
            ],
        ),
        (
            PovFinish {
                phong: 0.5,
                phong_size: 5.0,
                ..dull()
            },
            [
                [0.0636, 0.0636, 0.0636],
                [0.212528, 0.212528, 0.212528],
                [0.013565, 0.013565, 0.013565],
                [0.0, 0.0, 0.0],
            ],
        ),
        (
            PovFinish {
                specular: 0.5,
                roughness: 0.2,
                ..dull()
            },
            [
                [0.209751, 0.209751, 0.209751],
                [0.304875, 0.304875, 0.304875],
                [0.17644, 0.17644, 0.17644],
                [0.012894, 0.012894, 0.012894],
            ],
        ),
        (
            PovFinish {
                specular: 0.5,
                roughness: 0.2,
                metallic: 1.0,
                ..dull()
            },
            [
                [0.168597, 0.106889, 0.065736],
                [0.245045, 0.155291, 0.09546],
                [0.142931, 0.092683, 0.05919],
                [0.011414, 0.009201, 0.007721],
            ],
        ),
        (
            PovFinish {
                phong: 0.5,
                phong_size: 4.0,
                metallic: 0.5,
                ..dull()
            },
            [
                [0.080674, 0.067521, 0.058747],
                [0.21178, 0.177218, 0.154177],
                [0.023529, 0.019821, 0.017365],
                [0.0, 0.0, 0.0],
            ],
        ),
        (
            PovFinish {
                ambient: Color::gray(0.2),
                emission: Color::gray(0.1),
                ..dull()
            },
            [
                [0.239994, 0.149996, 0.089998],
                [0.239994, 0.149996, 0.089998],
                [0.239994, 0.149996, 0.089998],
                [0.239994, 0.149996, 0.089998],
            ],
        ),
    ];
    for (finish, values) in cases {
        for (n, expected) in NORMALS.iter().zip(values) {
            let n = DVec3::from_array(*n);
            let to_light = (DVec3::new(1000.0, 2000.0, -1500.0) - n).normalize();
            let diffuse = finish.diffuse_factor(n.dot(to_light)) * LIGHT;
            let body = PIGMENT * (finish.ambient + finish.emission + Color::gray(diffuse));
            let highlight = finish.highlight(n, to_light, DVec3::NEG_Z, PIGMENT) * LIGHT;
            let got = (body + highlight).to_array();
            for (g, e) in got.iter().zip(expected) {
                assert!(
                    (g - e).abs() < 2e-5,
                    "{finish:?}: {got:?} is not {expected:?}"
                );
            }
        }
    }
}

/// A mirror turned by 0, 30, 60 and 80 degrees, of colour `PIGMENT` and index 1.5, before a sky of <0.3, 0.6, 0.9>.
#[test]
fn reflects_as_measured() {
    let sky = Color::new(0.3, 0.6, 0.9);
    let cases: [(PovReflection, [[f64; 3]; 4]); 4] = [
        (
            PovReflection {
                falloff: 3.0,
                min: Color::gray(0.1),
                max: Color::gray(0.9),
                ..PovReflection::default()
            },
            [
                [0.029999, 0.059998, 0.089998],
                [0.030579, 0.061158, 0.091737],
                [0.059998, 0.119997, 0.179995],
                [0.165423, 0.330861, 0.496284],
            ],
        ),
        (
            PovReflection {
                fresnel: true,
                min: Color::gray(0.1),
                max: Color::gray(0.9),
                ..PovReflection::default()
            },
            [
                [0.039597, 0.079194, 0.118807],
                [0.039963, 0.079927, 0.11989],
                [0.051408, 0.102815, 0.154208],
                [0.123049, 0.246098, 0.369146],
            ],
        ),
        (
            PovReflection {
                metallic: 1.0,
                ..PovReflection::constant(Color::gray(0.5))
            },
            [
                [0.119997, 0.149996, 0.134997],
                [0.120363, 0.151781, 0.13875],
                [0.121782, 0.158892, 0.153674],
                [0.12784, 0.189166, 0.217258],
            ],
        ),
        (
            PovReflection {
                exponent: 2.0,
                ..PovReflection::constant(Color::gray(0.5))
            },
            [
                [0.273869, 0.387304, 0.474342],
                [0.273869, 0.387304, 0.474342],
                [0.273869, 0.387304, 0.474342],
                [0.273869, 0.387304, 0.474342],
            ],
        ),
    ];
    for (reflection, values) in cases {
        for (degrees, expected) in [0.0f64, 30.0, 60.0, 80.0].iter().zip(values) {
            let reflectance = reflection.reflectance(degrees.to_radians().cos(), PIGMENT, 1.5);
            let got = reflection.reflected(reflectance, sky).to_array();
            for (g, e) in got.iter().zip(expected) {
                assert!(
                    (g - e).abs() < 2e-5,
                    "{reflection:?}: {got:?} is not {expected:?}"
                );
            }
        }
    }
}

#[test]
fn grain_depends_on_the_place_and_stays_below_its_strength() {
    let finish = PovFinish {
        crand: 0.5,
        ..dull()
    };
    let values: Vec<f64> = (0..1000)
        .map(|i| finish.grain(DVec3::new(f64::from(i) * 1e-3, 0.0, 1.0)))
        .collect();
    assert!(values.iter().all(|g| (0.0..0.5).contains(g)));
    let mean = values.iter().sum::<f64>() / 1000.0;
    assert!((mean - 0.25).abs() < 0.02, "{mean}");
    assert_eq!(dull().grain(DVec3::ONE), 0.0);
}

/// Peak of a highlight of albedo 1.
#[test]
fn albedo_is_scaled_as_measured() {
    for (roughness, expected) in [
        (1.0, 0.5798),
        (0.2, 0.9598),
        (0.05, 2.7512),
        (0.01, 12.7497),
    ] {
        let got = PovFinish::specular_from_albedo(roughness);
        assert!((got - expected).abs() < 1e-3, "{roughness}: {got}");
    }
    assert_eq!(PovFinish::phong_from_albedo(5.0), 3.0);
    assert_eq!(PovFinish::diffuse_from_albedo(3.0), 2.0);
}

/// The two highlights by a shading model: both by half vectors, both around the mirror direction, or none.
#[test]
fn a_shading_model_takes_the_place_of_both_shapes() {
    let finish = PovFinish {
        phong: 0.5,
        phong_size: 20.0,
        specular: 0.25,
        roughness: 0.1,
        ..dull()
    };
    let n = DVec3::Z;
    let (l, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.28, 0.0, 0.96));
    let (r_dot_v, h_dot_n) = (crate::reflect(n, v).dot(l), (l + v).normalize().dot(n));
    let own = finish.highlights(n, l, v, None);
    assert_eq!((own.phong_cos, own.specular_cos), (r_dot_v, h_dot_n));
    assert_eq!(
        finish.highlight(n, l, v, PIGMENT),
        Color::WHITE * own.strength()
    );
    let phong = finish.highlights(n, l, v, Some(ShadingModel::Phong));
    assert_eq!((phong.phong, phong.specular_cos), (own.phong, r_dot_v));
    assert_eq!(phong.specular, 0.25 * det::pow(r_dot_v, 10.0));
    let blinn = finish.highlights(n, l, v, Some(ShadingModel::BlinnPhong));
    assert_eq!((blinn.specular, blinn.phong_cos), (own.specular, h_dot_n));
    let lambert = finish.highlights(n, l, v, Some(ShadingModel::Lambert));
    assert_eq!(lambert.strength(), 0.0);
}

#[test]
fn finishes_without_diffuse_light_and_highlights_show_no_lights() {
    let body = Color::gray(0.5);
    assert_eq!(dull().lights_shown(body), LightsShown::Nothing);
    let with = |change: fn(&mut PovFinish)| {
        let mut finish = dull();
        change(&mut finish);
        finish
    };
    assert_eq!(
        with(|f| f.phong = 0.1).lights_shown(Color::BLACK),
        LightsShown::Highlights
    );
    assert_eq!(
        with(|f| f.specular = 0.1).lights_shown(Color::BLACK),
        LightsShown::Highlights
    );
    assert_eq!(
        with(|f| f.diffuse_back = 0.1).lights_shown(body),
        LightsShown::All
    );
    // What is clear scatters nothing, except for its grain.
    assert_eq!(
        with(|f| f.diffuse = 0.1).lights_shown(body),
        LightsShown::All
    );
    assert_eq!(
        with(|f| f.diffuse = 0.1).lights_shown(Color::BLACK),
        LightsShown::Nothing
    );
    let grainy = with(|f| (f.diffuse, f.crand) = (0.1, 0.1));
    assert_eq!(grainy.lights_shown(Color::BLACK), LightsShown::All);
}

#[test]
fn light_that_does_not_show_makes_no_highlight() {
    let (normal, viewer) = (DVec3::Z, DVec3::new(0.6, 0.0, 0.8));
    let finishes = [
        PovFinish {
            specular: 1.0,
            roughness: 0.001,
            ..dull()
        },
        PovFinish {
            phong: 1e12,
            phong_size: 400.0,
            ..dull()
        },
        PovFinish {
            phong: 0.5,
            specular: 0.5,
            roughness: 0.1,
            ..dull()
        },
    ];
    for (finish, least) in finishes.iter().zip([1000, 1000, 0]) {
        let mut hidden = 0;
        for step in 0..2000 {
            let angle = f64::from(step) / 2000.0 * std::f64::consts::TAU;
            let light = DVec3::new(det::cos(angle), 0.0, det::sin(angle));
            let shows = finish.shows_light_from(Color::BLACK, normal, light, viewer);
            let parts = finish.highlights(normal, light, viewer, None);
            assert_eq!(shows, parts.phong + parts.specular > 0.0, "{angle}");
            hidden += usize::from(!shows);
        }
        assert!(hidden >= least, "{hidden}");
    }
    let matt = PovFinish {
        diffuse: 0.1,
        ..dull()
    };
    assert!(matt.shows_light_from(PIGMENT, normal, normal, viewer));
    assert!(!matt.shows_light_from(Color::BLACK, normal, normal, viewer));
}

#[test]
fn highlights_that_vanish_are_small() {
    let mut vanishing = 0;
    for power in [0.5, 64.0, 64.5, 100.0, 400.0, 1e3, 1e5, f64::INFINITY] {
        for step in 1..4000 {
            let cos = f64::from(step) / 4000.0;
            if highlight_vanishes(cos, power) {
                assert!(det::pow(cos, power) < 2.0f64.powi(-249), "{cos} {power}");
                vanishing += 1;
            }
        }
    }
    assert!(vanishing > 10_000, "{vanishing}");
    assert!(
        [0.0, -0.5, f64::NAN]
            .iter()
            .all(|cos| highlight_vanishes(*cos, 0.5))
    );
}
