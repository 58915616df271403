//! The second pass of adaptive antialiasing. Pixels of a tile take more samples in rounds: first towards neighbours that differ from them, then wherever the
//! means that are known by then differ.

use super::pixels::{Packet, PixelTracer, squares};
use super::refine::Comparison;
use super::{Samples, TileResult};
use crate::beam::BeamMask;
use crate::cost::PixelCost;
use crate::film::Region;
use crate::sampling::{Quadrants, Sample};
use strahl_accel::PACKET;
use strahl_shade::Color;

/// A pixel that takes more samples. Its first one, at the centre, stands for the places in quadrants where there are no others.
struct Refined {
    at: (u32, u32),
    first: Sample,
    /// The quadrants with samples, and those that shall have some.
    known: Quadrants,
    wanted: Quadrants,
    /// The samples of each quadrant.
    parts: [Samples; Quadrants::COUNT],
    mean: Sample,
}

impl Refined {
    /// Computes the mean, given how many samples all quadrants have.
    fn sum_up(&mut self, most: u32) {
        let all = self
            .parts
            .iter()
            .fold(Samples::NONE, |all, part| all.plus(*part));
        let left_out = most - all.count;
        self.mean = all.with_many(self.first, 1 + left_out).sample();
    }
}

/// The pixels of a tile that take more samples.
struct Pixels<F> {
    tile: Region,
    /// The first samples of the tile's pixels.
    first: F,
    list: Vec<Refined>,
    /// By pixel of the tile, its number in the list.
    numbers: Vec<Option<usize>>,
    /// The numbers of those whose samples are wanted next.
    waiting: Vec<usize>,
}

impl<F: Fn(u32, u32) -> Sample> Pixels<F> {
    fn new(tile: Region, first: F) -> Self {
        Self {
            tile,
            first,
            list: Vec::new(),
            numbers: vec![None; tile.pixels() as usize],
            waiting: Vec::new(),
        }
    }

    fn number(&self, at: (u32, u32)) -> Option<usize> {
        self.numbers[self.tile.index(at.0, at.1)]
    }

    /// Wants the samples in some quadrants of a pixel.
    fn want(&mut self, at: (u32, u32), quadrants: Quadrants) {
        let number = self.number(at).unwrap_or_else(|| {
            let first = (self.first)(at.0, at.1);
            self.list.push(Refined {
                at,
                first,
                known: Quadrants::NONE,
                wanted: Quadrants::NONE,
                parts: [Samples::NONE; Quadrants::COUNT],
                mean: first,
            });
            self.numbers[self.tile.index(at.0, at.1)] = Some(self.list.len() - 1);
            self.list.len() - 1
        });
        let pixel = &mut self.list[number];
        let waits = !(pixel.wanted - pixel.known).is_none();
        pixel.wanted |= quadrants;
        if !waits && !(pixel.wanted - pixel.known).is_none() {
            self.waiting.push(number);
        }
    }

    /// Compares the means of pixels with the first samples of neighbours that are not refined. Where they differ, both want samples: the pixel on that side, its neighbour everywhere,
    /// because a line may go on in any direction.
    ///
    /// POV-Ray, too, compares with the means of neighbours that are refined already: those to the left and above (measured).
    fn compare(&mut self, comparison: &Comparison<'_>, numbers: &[usize]) {
        let mut colors: Vec<Color> = numbers.iter().map(|n| self.list[*n].mean.color).collect();
        let mut sides = Vec::new();
        for (n, &number) in numbers.iter().enumerate() {
            let at = self.list[number].at;
            let (x, y) = at;
            for (beside, side) in [
                ((x.wrapping_sub(1), y), Quadrants::LEFT),
                ((x + 1, y), Quadrants::RIGHT),
                ((x, y.wrapping_sub(1)), Quadrants::ABOVE),
                ((x, y + 1), Quadrants::BELOW),
            ] {
                if self.tile.contains(beside.0, beside.1) && self.number(beside).is_none() {
                    sides.push((n, at, side, beside));
                    colors.push((self.first)(beside.0, beside.1).color);
                }
            }
        }
        comparison.decode(&mut colors);
        let (means, firsts) = colors.split_at(numbers.len());
        let pairs = sides.iter().zip(firsts);
        let pairs: Vec<[Color; 2]> = pairs.map(|((n, ..), first)| [means[*n], *first]).collect();
        let differ = comparison.differ(&pairs);
        for ((_, at, side, beside), _) in sides.into_iter().zip(differ).filter(|(_, d)| *d) {
            self.want(at, side);
            self.want(beside, Quadrants::ALL);
        }
    }
}

impl PixelTracer<'_> {
    /// The means of the pixels of a tile that take more samples than the first one, and the quadrants in which they do. `quadrants` returns those in which a pixel differs from
    /// neighbours, `first` its first sample.
    ///
    /// There are rounds until no more samples are wanted: so a thin line that the first samples meet here and there is followed.
    pub(super) fn refined(
        &mut self,
        tile: Region,
        comparison: &Comparison<'_>,
        quadrants: impl Fn(u32, u32) -> Quadrants,
        first: impl Fn(u32, u32) -> Sample,
    ) -> TileResult<Option<(Sample, Quadrants)>> {
        self.start_tile();
        let mask = self.beam_mask(tile);
        let count = tile.pixels() as usize;
        let mut costs = vec![PixelCost::default(); if self.options.costs { count } else { 0 }];
        let mut pixels = Pixels::new(tile, first);
        for (x, y) in squares(tile).flat_map(Region::positions) {
            let quadrants = quadrants(x, y);
            if !quadrants.is_none() {
                pixels.want((x, y), quadrants);
            }
        }
        loop {
            let round = std::mem::take(&mut pixels.waiting);
            if round.is_empty() || !self.refine(tile, &round, &mut pixels.list, &mask, &mut costs) {
                break;
            }
            pixels.compare(comparison, &round);
        }
        let mut values = vec![None; count];
        for pixel in &pixels.list {
            values[tile.index(pixel.at.0, pixel.at.1)] = Some((pixel.mean, pixel.known));
        }
        self.end_tile(tile, None, values, costs)
    }

    /// Takes the wanted samples of pixels, which are given by their numbers in a list; false if the tile is left before the end. Packets have samples of several pixels.
    fn refine(
        &mut self,
        tile: Region,
        numbers: &[usize],
        list: &mut [Refined],
        mask: &BeamMask,
        costs: &mut [PixelCost],
    ) -> bool {
        let mut packet = Packet::new();
        // Of bundles of rays.
        let (mut places, mut parts) = (Vec::new(), Vec::new());
        let options = self.options;
        let most = options.sampling.places(1, 0, 0, 0).len() as u32;
        // The number of a part of a pixel, and back.
        let part_of = |number: usize, quadrant: usize| number * Quadrants::COUNT + quadrant;
        let add = |list: &mut [Refined], part: usize, sample: Sample| {
            list[part / Quadrants::COUNT].parts[part % Quadrants::COUNT].add(sample);
        };
        for (n, &number) in numbers.iter().enumerate() {
            if n.is_multiple_of(PACKET) && self.leaves() {
                return false;
            }
            let pixel = &mut list[number];
            let (x, y) = pixel.at;
            let wanted = pixel.wanted - pixel.known;
            pixel.known = pixel.wanted;
            self.blind = mask.is_empty(x, y);
            for place in options.sampling.places(1, x, y, options.seed) {
                let quadrant = Quadrants::of(place);
                if !wanted.has(quadrant) {
                    continue;
                }
                let at = (f64::from(x) + place.0, f64::from(y) + place.1);
                if self.bundled {
                    places.push(at);
                    parts.push(part_of(number, quadrant));
                } else if self.together && !self.blind {
                    packet.push((part_of(number, quadrant), self.rays.ray(at.0, at.1)));
                    if packet.is_full() {
                        self.trace_packet(&mut packet, |part, sample| add(list, part, sample));
                    }
                } else if options.costs {
                    let (sample, cost) = self.measured(|tracer| tracer.sample(at.0, at.1, false));
                    costs[tile.index(x, y)] += cost;
                    add(list, part_of(number, quadrant), sample);
                } else {
                    let sample = self.sample(at.0, at.1, false);
                    add(list, part_of(number, quadrant), sample);
                }
            }
        }
        self.trace_packet(&mut packet, |part, sample| add(list, part, sample));
        let mut means = vec![Sample::BLACK; places.len()];
        self.means(places.into_iter(), |n, mean| means[n] = mean);
        for (part, mean) in parts.into_iter().zip(means) {
            add(list, part, mean);
        }
        for &number in numbers {
            list[number].sum_up(most);
        }
        true
    }
}
