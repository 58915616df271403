//! Finds the known name that a misspelt one probably stands for.

/// A possible replacement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate<'a> {
    name: &'a str,
    letters: u64,
}

impl<'a> Candidate<'a> {
    pub(crate) fn new(name: &'a str) -> Self {
        let letters = letters(name);
        Self { name, letters }
    }
}

/// The set of letters in a name, one bit for each; case is ignored.
fn letters(name: &str) -> u64 {
    name.bytes()
        .fold(0, |set, b| set | 1 << (b.to_ascii_lowercase() & 63))
}

/// The name with the smallest edit distance (the first of several) and its data, if at most a third of the letters differ; a single letter
/// only in case.
pub(crate) fn closest<'a, T>(
    name: &str,
    known: impl Iterator<Item = (Candidate<'a>, T)>,
) -> Option<(&'a str, T)> {
    let wanted = letters(name);
    let mut allowed = match name.chars().count() {
        0 | 1 => 0,
        count => (count / 3).clamp(1, 4),
    };
    let mut best = None;
    for (candidate, about) in known {
        // A replaced letter changes at most two bits of the set, so most candidates are skipped quickly.
        let differing = (candidate.letters ^ wanted).count_ones() as usize;
        if differing > 2 * allowed
            || candidate.name.len().abs_diff(name.len()) > allowed
            || candidate.name == name
        {
            continue;
        }
        let distance = distance(name, candidate.name);
        if distance <= allowed {
            best = Some((candidate.name, about));
            // Later candidates must be better.
            match distance.checked_sub(1) {
                Some(less) => allowed = less,
                None => break,
            }
        }
    }
    best
}

/// The Levenshtein distance of the bytes, ignoring case.
fn distance(a: &str, b: &str) -> usize {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (y, above) in b.iter().zip(row.iter_mut().skip(1)) {
            let replaced = diagonal + usize::from(!x.eq_ignore_ascii_case(y));
            diagonal = *above;
            left = replaced.min(diagonal + 1).min(left + 1);
            *above = left;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_is_found() {
        let known = ["sphere", "Ruby_Glass", "box", "cylinder"];
        let find = |name: &str| {
            closest(name, known.iter().map(|k| (Candidate::new(k), ()))).map(|(k, ())| k)
        };
        assert_eq!(find("shpere"), Some("sphere"));
        assert_eq!(find("ruby_glass"), Some("Ruby_Glass"));
        assert_eq!(find("Ruby_Gless"), Some("Ruby_Glass"));
        assert_eq!(find("cone"), None);
        assert_eq!(find(""), None);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
