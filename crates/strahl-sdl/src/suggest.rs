//! Which known name a misspelt one may mean.

/// The name with the smallest edit distance, if it is close enough: at most a third of the letters differ.
pub(crate) fn closest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (name.chars().count() / 3).clamp(1, 4);
    let mut best: Option<(usize, &str)> = None;
    for candidate in known {
        if candidate.len().abs_diff(name.len()) > allowed || candidate == name {
            continue;
        }
        let distance = distance(name, candidate);
        if distance <= allowed && best.is_none_or(|(d, _)| distance < d) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Levenshtein's distance; capital and small letters count as half a difference would, that is as none.
fn distance(a: &str, b: &str) -> usize {
    let (a, b) = (a.to_ascii_lowercase(), b.to_ascii_lowercase());
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            left = replaced.min(diagonal + 1).min(left + 1);
            row[j + 1] = left;
        }
        row[0] = i + 1;
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_is_found() {
        let known = ["sphere", "Ruby_Glass", "box", "cylinder"];
        let find = |name: &str| closest(name, known.iter().copied());
        assert_eq!(find("shpere"), Some("sphere"));
        assert_eq!(find("ruby_glass"), Some("Ruby_Glass"));
        assert_eq!(find("Ruby_Gless"), Some("Ruby_Glass"));
        assert_eq!(find("cone"), None);
        assert_eq!(find(""), None);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
