//! What `trace()` and `inside()` answer about surfaces and fractals, against values that are known without the program.

use crate::common::debug;

/// A ray, and where it meets the object with which normal; `None` where it passes.
type Asked<'a> = (&'a str, &'a str, Option<(&'a str, &'a str)>);

/// A name, statements that declare `Thing`, its rays, and points that are inside and outside of it.
type Row<'a> = (
    &'a str,
    &'a str,
    &'a [Asked<'a>],
    &'a [&'a str],
    &'a [&'a str],
);

/// A ball of radius 1: a half circle of five points turned around y.
const BALL: &str = "
    #declare Circle = array[9] { <1, 0>, <1, 1>, <0, 1>, <-1, 1>, <-1, 0>, <-1, -1>, <0, -1>, <1, -1>, <1, 0> }
    #declare Arc = array[5] { <0, -1>, <1, -1>, <1, 0>, <1, 1>, <0, 1> }
    #declare Weight = function(i) { select(mod(i, 2), 1, 1, sqrt(0.5)) }
    #declare Thing = nurbs {
      degree 2
      u_knots { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
      v_knots { 0, 0, 0, 1, 1, 2, 2, 2 }
      #for (J, 0, 4)
        row { #for (I, 0, 8) <Arc[J].x * Circle[I].x, Arc[J].y, Arc[J].x * Circle[I].y, Weight(I) * Weight(J)> #end }
      #end
    }";

/// Control points whose surface is z = x² over the unit square; its front, to which dS/dv × dS/du points, is that towards low z.
const VALLEY: &str = "
    #declare Thing = bicubic_patch {
      type 1 flatness 0 u_steps 3 v_steps 3
      #for (J, 0, 3) <0, J/3, 0>, <1/3, J/3, 0>, <2/3, J/3, 1/3>, <1, J/3, 1> #end
    }";

/// A quarter of a cylinder of radius 1 around z.
const QUARTER: &str = "
    #declare Thing = nurbs {
      degree <2, 1>
      #for (J, 0, 1) row { <1, 0, 2 * J>, <1, 1, 2 * J, sqrt(0.5)>, <0, 1, 2 * J> } #end
    }";

/// A cylinder of radius 1 around z, from 0 to 2: a tube and two discs that are trimmed from squares.
const CAN: &str = "
    #declare Circle = array[9] { <1, 0>, <1, 1>, <0, 1>, <-1, 1>, <-1, 0>, <-1, -1>, <0, -1>, <1, -1>, <1, 0> }
    #declare Weight = function(i) { select(mod(i, 2), 1, 1, sqrt(0.5)) }
    #declare Lid = nurbs {
      degree 1 u_knots { -2, -2, 2, 2 } v_knots { -2, -2, 2, 2 }
      row { <-2, -2, 0>, <2, -2, 0> } row { <-2, 2, 0>, <2, 2, 0> }
      trim { curve {
        degree 2 knots { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
        #for (I, 0, 8) <Circle[I].x, Circle[I].y, Weight(I)> #end
      } }
    }
    #declare Thing = brep {
      Lid object { Lid translate 2 * z }
      nurbs {
        degree <2, 1> u_knots { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
        #for (J, 0, 1) row { #for (I, 0, 8) <Circle[I].x, Circle[I].y, 2 * J, Weight(I)> #end } #end
      }
    }";

/// A cube of side 2. The limit of a corner of three faces is (9 v + 4 Σ e + Σ f) / 24, where e are its neighbours and f those across
/// the faces; that of the middle of a face is the one of its point after one level, (16 v + 4 Σ e + Σ f) / 36.
const CUBE: &str = "
    #declare Thing = subdivision {
      catmull_clark
      points { #for (I, 0, 7) <2 * mod(I, 2) - 1, 2 * mod(floor(I / 2), 2) - 1, 2 * floor(I / 4) - 1> #end }
      face { 0, 4, 6, 2 } face { 1, 3, 7, 5 } face { 0, 1, 5, 4 } face { 2, 6, 7, 3 } face { 0, 2, 3, 1 } face { 4, 5, 7, 6 }
    }";

/// An octahedron. Loop's limit of a vertex v of four neighbours is 24/55 v + 31/220 Σ e.
const OCTAHEDRON: &str = "
    #declare Thing = subdivision {
      loop
      points { x, -x, y, -y, z, -z }
      face { 0, 2, 4 } face { 2, 1, 4 } face { 1, 3, 4 } face { 3, 0, 4 }
      face { 2, 0, 5 } face { 1, 2, 5 } face { 3, 1, 5 } face { 0, 3, 5 }
    }";

const RIDGES: &str = "
    #include \"functions.inc\"
    #declare Height = function(a, b) { f_ridged_mf(a, 0, b, 0.9, 2.1, 5, 1, 2, 2) }
    #declare Thing = terrain { ridged h 0.9 lacunarity 2.1 octaves 5 offset 1 gain 2 noise_generator 2 extent <-4, -4>, <4, 4> }";

const HILLS: &str = "
    #include \"functions.inc\"
    #declare Height = function(a, b) { f_hetero_mf(a, 0, b, 0.8, 2, 4, 0.7, 1, 3) }
    #declare Thing = terrain { hetero h 0.8 lacunarity 2 octaves 4 offset 0.7 noise_generator 3 extent <-4, -4>, <4, 4> }";

const ROWS: &[Row<'_>] = &[
    (
        "bicubic patch",
        VALLEY,
        &[
            (
                "<0.5, 0.3, -5>",
                "z",
                Some(("<0.5, 0.3, 0.25>", "<1, 0, -1> / sqrt(2)")),
            ),
            (
                "<0.25, 0.75, 9>",
                "-z",
                Some(("<0.25, 0.75, 0.0625>", "<0.5, 0, -1> / sqrt(1.25)")),
            ),
            (
                "<5, 0.5, 0.25>",
                "-x",
                Some(("<0.5, 0.5, 0.25>", "<1, 0, -1> / sqrt(2)")),
            ),
            ("<1.01, 0.5, -5>", "z", None),
            ("<0.5, 0.5, 5>", "z", None),
        ],
        &[],
        &["<0.5, 0.5, 0.2>", "<0.5, 0.5, 0.3>", "0"],
    ),
    (
        "open NURBS",
        QUARTER,
        &[
            (
                "<3, 4, 1>",
                "<-3, -4, 0>",
                Some(("<0.6, 0.8, 1>", "<0.6, 0.8, 0>")),
            ),
            (
                "<0, 0, 0.5>",
                "<4, 3, 0>",
                Some(("<0.8, 0.6, 0.5>", "<0.8, 0.6, 0>")),
            ),
            ("<3, 4, 2.01>", "<-3, -4, 0>", None),
            ("<-3, 4, 1>", "<3, -4, 0>", None),
        ],
        &[],
        &["<0.5, 0.5, 1>", "<2, 2, 1>"],
    ),
    (
        "closed NURBS",
        BALL,
        &[
            (
                "<3, 0.48, 0.64>",
                "-x",
                Some(("<0.6, 0.48, 0.64>", "<0.6, 0.48, 0.64>")),
            ),
            (
                "<0.48, 0.6, -7>",
                "z",
                Some(("<0.48, 0.6, -0.64>", "<0.48, 0.6, -0.64>")),
            ),
            (
                "0",
                "<0.1, 0.7, -0.7>",
                Some((
                    "<0.1, 0.7, -0.7> / sqrt(0.99)",
                    "<0.1, 0.7, -0.7> / sqrt(0.99)",
                )),
            ),
            ("<3, 0.8, 0.61>", "-x", None),
        ],
        &[
            "0",
            "<0.57, 0.57, 0.57>",
            "<-0.57, -0.57, 0.57>",
            "<0, 0.999, 0.01>",
            "-0.99 * z",
        ],
        &[
            "<0.58, 0.58, 0.58>",
            "<-0.58, -0.58, 0.58>",
            "<0, 1.001, 0.01>",
            "-1.01 * z",
            "10",
        ],
    ),
    (
        "trimmed NURBS that close a volume",
        CAN,
        &[
            (
                "<3, 4, 1>",
                "<-3, -4, 0>",
                Some(("<0.6, 0.8, 1>", "<0.6, 0.8, 0>")),
            ),
            ("<0.3, 0.4, -9>", "z", Some(("<0.3, 0.4, 0>", "-z"))),
            ("<0.3, 0.4, 1>", "z", Some(("<0.3, 0.4, 2>", "z"))),
            ("<0.61, 0.8, -9>", "z", None),
        ],
        &["z", "<0.59, 0.8, 0.001>", "<-0.59, -0.8, 1.999>"],
        &["<0.61, 0.8, 1>", "-0.001 * z", "2.001 * z"],
    ),
    (
        "Catmull and Clark's surface of a cube",
        CUBE,
        &[
            ("9 * x", "-x", Some(("68/81 * x", "x"))),
            ("-9 * z", "z", Some(("-68/81 * z", "-z"))),
            ("0", "-y", Some(("-68/81 * y", "-y"))),
            (
                "<4, 4, -4>",
                "<-1, -1, 1>",
                Some(("<0.5, 0.5, -0.5>", "<1, 1, -1> / sqrt(3)")),
            ),
            ("<0.9, 0.9, -4>", "z", None),
        ],
        &[
            "0",
            "0.839 * x",
            "-0.839 * y",
            "0.499",
            "<-0.499, 0.499, -0.499>",
        ],
        &[
            "0.84 * x",
            "-0.84 * y",
            "0.501",
            "<-0.501, 0.501, -0.501>",
            "1",
        ],
    ),
    (
        "Loop's surface of an octahedron",
        OCTAHEDRON,
        &[
            ("9 * x", "-x", Some(("24/55 * x", "x"))),
            ("0", "-z", Some(("-24/55 * z", "-z"))),
            ("<0.44, 0, -4>", "z", None),
        ],
        &["0", "0.436 * x", "-0.436 * y"],
        &["0.437 * x", "-0.437 * y", "x"],
    ),
    (
        "ridged terrain",
        RIDGES,
        &[
            (
                "<0.3, 9, 0.7>",
                "-y",
                Some(("<0.3, Height(0.3, 0.7), 0.7>", "")),
            ),
            (
                "<-2.9, 9, 3.1>",
                "-y",
                Some(("<-2.9, Height(-2.9, 3.1), 3.1>", "")),
            ),
            (
                "<1.2, -9, 2.3>",
                "y",
                Some(("<1.2, Height(1.2, 2.3), 2.3>", "")),
            ),
            ("<4.1, 9, 0>", "-y", None),
        ],
        &["<0.3, Height(0.3, 0.7) - 0.001, 0.7>", "<0.3, -100, 0.7>"],
        &["<0.3, Height(0.3, 0.7) + 0.001, 0.7>", "<4.1, -100, 0.7>"],
    ),
    (
        "hilly terrain",
        HILLS,
        &[
            (
                "<0.3, 9, 0.7>",
                "-y",
                Some(("<0.3, Height(0.3, 0.7), 0.7>", "")),
            ),
            (
                "<-2.9, 9, 3.1>",
                "-y",
                Some(("<-2.9, Height(-2.9, 3.1), 3.1>", "")),
            ),
            ("<0, 9, 4.1>", "-y", None),
        ],
        &["<-2.9, Height(-2.9, 3.1) - 0.001, 3.1>"],
        &["<-2.9, Height(-2.9, 3.1) + 0.001, 3.1>", "<0, -100, 4.1>"],
    ),
    // On the axis of its angles the power of a point is that of a number: z² + z = 2. Points of the x axis go to its other end.
    (
        "Mandelbulb",
        "#declare Thing = mandelbulb { 2 max_iteration 1 } #declare R = sqrt((sqrt(17) - 1) / 2);",
        &[
            ("9 * z", "-z", Some(("z", "z"))),
            ("9 * x", "-x", Some(("R * x", ""))),
            ("<2.1, 0, -9>", "z", None),
        ],
        &["0", "0.999 * z", "(R - 0.001) * x", "-1.9 * z"],
        &["1.001 * z", "(R + 0.001) * x", "-2.01 * z"],
    ),
    // All powers of points of the unit sphere are on it.
    (
        "Mandelbulb's Julia set of 0",
        "#declare Thing = mandelbulb { 8 max_iteration 3 julia 0 }",
        &[
            (
                "<3, 0.48, 0.64>",
                "-x",
                Some(("<0.6, 0.48, 0.64>", "<0.6, 0.48, 0.64>")),
            ),
            ("<3, 0.8, 0.61>", "-x", None),
        ],
        &["0", "<0.57, 0.57, 0.57>"],
        &["<0.58, 0.58, 0.58>", "-1.01 * z"],
    ),
    // The cells are those of the integers. Those with two or three coordinates in the middle third are holes.
    (
        "Menger's sponge",
        "#declare Thing = menger { 0, 3, 1 }",
        &[
            ("<0.5, 0.4, -9>", "z", Some(("<0.5, 0.4, 0>", "-z"))),
            ("<1.5, 0.4, 9>", "-z", Some(("<1.5, 0.4, 3>", "z"))),
            ("<1.5, 1.4, -9>", "z", None),
            ("1.5", "<1, 0.5, 0>", Some(("<2.5, 2, 1.5>", "-y"))),
        ],
        &["<0.5, 0.5, 0.5>", "<1.5, 0.5, 0.5>", "<2.5, 2.5, 1.5>"],
        &[
            "<1.5, 1.5, 0.5>",
            "<1.5, 0.5, 1.5>",
            "1.5",
            "<0.5, 0.5, -0.01>",
            "3.01",
        ],
    ),
    (
        "Menger's sponge of level 2",
        "#declare Thing = menger { -9, 0, 2 }",
        &[
            ("<-7.5, -7.5, 5>", "-z", None),
            ("<-7.5, -8.5, 5>", "-z", Some(("<-7.5, -8.5, 0>", "z"))),
            ("<-4.5, -4.5, 5>", "-z", None),
        ],
        &["<-8.5, -8.5, -8.5>", "<-7.5, -8.5, -8.5>"],
        &["<-7.5, -7.5, -8.5>", "<-4.5, -4.5, -8.5>"],
    ),
];

/// The numbers that a text writes.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split([',', ' ']).filter(|w| !w.is_empty());
    words.map(|w| w.parse().expect("a number")).collect()
}

fn is_near(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[test]
fn rays_meet_surfaces_and_fractals_where_they_are() {
    for (name, text, rays, ..) in ROWS {
        for (origin, direction, expected) in *rays {
            let (point, normal) = expected.unwrap_or(("0", "0"));
            // A normal that is not given is only one of length 1.
            let normal = if normal.is_empty() { "N" } else { normal };
            let said = debug(&format!(
                "{text} #declare N = 5; #declare P = trace(Thing, {origin}, {direction}, N);
                 #declare E = <0, 0, 0> + {point}; #declare M = <0, 0, 0> + {normal};
                 #for (I, 0, 3) #debug concat(vstr(3, (I = 0 ? P : I = 1 ? N : I = 2 ? E : M), \",\", 0, 12), \" \") #end"
            ));
            let all = numbers(&said);
            let [place, n, e, m] = [0, 3, 6, 9].map(|k| &all[k..k + 3]);
            let length: f64 = n.iter().map(|x| x * x).sum();
            let is_unit = expected.is_none() || (length - 1.0).abs() < 1e-9;
            assert!(
                is_near(place, e) && is_near(n, m) && is_unit,
                "{name}, from {origin} along {direction}: found {place:?} with {n:?}, expected {e:?} with {m:?}"
            );
        }
    }
}

#[test]
fn points_are_inside_of_what_has_an_inside() {
    for (name, text, _, inside, outside) in ROWS {
        for (points, expected) in [(inside, "in"), (outside, "out")] {
            for point in *points {
                let said = debug(&format!(
                    "{text} #if (inside(Thing, {point})) #debug \"in\" #else #debug \"out\" #end"
                ));
                assert_eq!(&said, expected, "{name}: {point}");
            }
        }
    }
}
