use strahl_math::{Aabb, DVec3};

/// A ball in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

/// A factor above the rounding error of a sum or square root of a few terms.
const UP: f64 = 1.0 + 16.0 * f64::EPSILON;

impl Ball {
    /// The ball around a box.
    pub(super) fn around_box(b: &Aabb) -> Self {
        let center = b.center();
        Self {
            center,
            radius: farthest_corner(center, b),
        }
    }

    /// The smallest ball around two.
    pub(super) fn around_two(a: &Self, b: &Self) -> Self {
        let way = b.center - a.center;
        let distance = way.length();
        if distance + b.radius <= a.radius {
            return *a;
        }
        if distance + a.radius <= b.radius {
            return *b;
        }
        let radius = 0.5 * (distance + a.radius + b.radius);
        // Not zero, because otherwise one would contain the other.
        let center = a.center + way * ((radius - a.radius) / distance);
        let mut ball = Self { center, radius };
        ball.radius = longer(ball.reach(a), ball.reach(b));
        ball
    }

    /// The distance from the centre to the farthest point of another ball.
    pub(super) fn reach(&self, other: &Self) -> f64 {
        ((other.center - self.center).length() + other.radius) * UP
    }

    /// The distance from the centre to the farthest point of a primitive, given its box and a ball around it.
    fn reach_of(&self, member: &Member) -> f64 {
        let (ball, corner) = (
            self.reach(&member.ball),
            farthest_corner(self.center, &member.bounds),
        );
        if corner < ball { corner } else { ball }
    }

    /// A small ball around primitives, not necessarily the smallest: the best of three centres. `hint` is a ball that
    /// contains them.
    pub(super) fn around(members: &[Member], hint: &Self) -> Self {
        let Some(first) = members.first() else {
            return *hint;
        };
        if members.len() == 1 {
            return first.ball;
        }
        let bounds = members.iter().fold(Aabb::EMPTY, |b, m| b.union(&m.bounds));
        let ritter = Self::ritter(members);
        let mut best = *hint;
        for center in [bounds.center(), hint.center, ritter.center] {
            let mut ball = Self {
                center,
                radius: 0.0,
            };
            for member in members {
                ball.radius = longer(ball.radius, ball.reach_of(member));
                if ball.radius >= best.radius {
                    break;
                }
            }
            if ball.radius < best.radius {
                best = ball;
            }
        }
        best
    }

    /// Ritter's ball: two primitives far apart, then enlarged by each that sticks out. (An efficient bounding sphere,
    /// Graphics Gems, 1990; with balls for points.)
    fn ritter(members: &[Member]) -> Self {
        let farthest = |from: &Self| {
            members.iter().fold(*from, |far, m| {
                if from.reach(&m.ball) > from.reach(&far) {
                    m.ball
                } else {
                    far
                }
            })
        };
        let a = farthest(&members[0].ball);
        let b = farthest(&a);
        let mut ball = Self::around_two(&a, &b);
        for m in members {
            if ball.reach(&m.ball) > ball.radius {
                ball = Self::around_two(&ball, &m.ball);
            }
        }
        ball
    }
}

/// A primitive while the tree is built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) id: u32,
    pub(super) bounds: Aabb,
    pub(super) ball: Ball,
}

fn longer(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Distance of a point from the corner of a box that is farthest from it.
fn farthest_corner(p: DVec3, b: &Aabb) -> f64 {
    (p - b.min).abs().max((b.max - p).abs()).length() * UP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(x: f64, radius: f64) -> Ball {
        Ball {
            center: DVec3::X * x,
            radius,
        }
    }

    #[test]
    fn the_ball_around_two_touches_both() {
        let both = Ball::around_two(&ball(-1.0, 1.0), &ball(3.0, 2.0));
        assert!((both.center - DVec3::X * 1.5).length() < 1e-12);
        assert!((both.radius - 3.5).abs() < 1e-12 && both.radius >= 3.5);
        let small = ball(0.5, 0.5);
        assert_eq!(Ball::around_two(&ball(0.0, 1.0), &small), ball(0.0, 1.0));
        assert_eq!(Ball::around_two(&small, &ball(0.0, 1.0)), ball(0.0, 1.0));
    }

    #[test]
    fn the_ball_around_many_is_smaller_than_that_of_their_box() {
        // Small balls all over a large sphere: their box's ball is larger by the square root of 3.
        let members: Vec<Member> = (0..200)
            .map(|i| {
                let z = f64::from(i) / 100.0 - 0.995;
                let angle = f64::from(i) * 2.4;
                let around = (1.0 - z * z).sqrt();
                let center = DVec3::new(around * angle.cos(), around * angle.sin(), z);
                let margin = DVec3::splat(0.01);
                Member {
                    id: i as u32,
                    bounds: Aabb::new(center - margin, center + margin),
                    ball: Ball {
                        center,
                        radius: 0.01,
                    },
                }
            })
            .collect();
        let whole = members.iter().fold(Aabb::EMPTY, |b, m| b.union(&m.bounds));
        let ball = Ball::around(&members, &Ball::around_box(&whole));
        assert!(ball.radius > 1.0 && ball.radius < 1.05, "{ball:?}");
        for m in &members {
            assert!((m.ball.center - ball.center).length() + 0.01 <= ball.radius);
        }
    }
}
