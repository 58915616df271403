use super::*;

fn whole(bytes: &[u8]) -> Lexed {
    let part = Part {
        bytes,
        begin: 0,
        is_last: true,
    };
    lex(&part, 0, usize::MAX, &mut Symbols::new(), Lexed::default())
}

fn kinds(text: &str) -> Vec<Kind> {
    let lexed = whole(text.as_bytes());
    assert_eq!(lexed.problems, []);
    lexed.tokens.iter().map(|t| t.kind).collect()
}

fn numbers(text: &str) -> Vec<f64> {
    let lexed = whole(text.as_bytes());
    let numbers = lexed.tokens.iter().filter(|t| t.kind == Kind::Number);
    numbers.map(|t| t.number()).collect()
}

#[test]
fn a_sphere_is_cut_into_its_tokens() {
    use Kind::{Comma, End, Greater, LeftBrace, Less, Minus, Name, Number, RightBrace, Word};
    let text = "sphere{<0,-1,My_2> .5}";
    let expected = [
        Word, LeftBrace, Less, Number, Comma, Minus, Number, Comma, Name, Greater, Number,
        RightBrace, End,
    ];
    assert_eq!(kinds(text), expected);
}

#[test]
fn numbers_are_read_to_the_last_bit() {
    let text = "0 1. .5 1e3 1.5E-3 2e+2 0.1 3.14159265358979323846 123456789012345678901234567890 1e400 4.35 007";
    let expected = [
        0.0,
        1.0,
        0.5,
        1e3,
        1.5e-3,
        2e2,
        0.1,
        std::f64::consts::PI,
        123456789012345678901234567890.0,
        f64::INFINITY,
        4.35,
        7.0,
    ];
    assert_eq!(numbers(text), expected);
    // All code paths of the number parser agree with the standard library.
    let mut state = 1u64;
    for _ in 0..20_000 {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let digits = (state >> 60) as usize;
        let text = format!("{:.*}", digits, (state >> 11) as f64 / 1e12);
        assert_eq!(numbers(&text), [text.parse::<f64>().unwrap()], "{text}");
    }
}

#[test]
fn points_that_are_no_fractions() {
    assert_eq!(kinds("A.x"), [Kind::Name, Kind::Dot, Kind::Word, Kind::End]);
    assert_eq!(
        kinds("2.x"),
        [Kind::Number, Kind::Dot, Kind::Word, Kind::End]
    );
}

#[test]
fn comments_nest_and_strings_hide_them() {
    assert_eq!(
        kinds("1 /* a /* b */ // c */ 2 // d \n+"),
        [Kind::Number, Kind::Number, Kind::Plus, Kind::End]
    );
    let lexed = whole(br#""/* \"quoted\" \u00e9\n""#);
    assert_eq!(lexed.strings, [Arc::from("/* \"quoted\" \u{e9}\n")]);
    let latin = whole(b"\"caf\xe9\"");
    assert_eq!(latin.strings, [Arc::from("caf\u{e9}")]);
}

#[test]
fn a_second_point_in_a_number_is_reported() {
    for (text, start) in [("1.5.5", 3), ("<0,.0.95>", 5), ("1e5.2", 3)] {
        let lexed = whole(text.as_bytes());
        assert_eq!(lexed.problems.len(), 1, "{text}");
        assert_eq!(lexed.problems[0].start, start);
    }
}

#[test]
fn unfinished_text_is_reported_where_it_starts() {
    for (text, start) in [("1 /* /* */", 2), ("12 \"abc", 3), ("\"a\\", 0)] {
        let lexed = whole(text.as_bytes());
        assert_eq!(lexed.problems.len(), 1, "{text}");
        assert_eq!(lexed.problems[0].start, start);
        assert_eq!(lexed.tokens.last().map(|t| t.kind), Some(Kind::End));
    }
}

#[test]
fn blocks_are_linked() {
    let text = "#if(1) #while(0) #end #else # switch(1) #case(1) #break #end #end #end #macro A()";
    let lexed = whole(text.as_bytes());
    let directives: Vec<&Token> = lexed
        .tokens
        .iter()
        .filter(|t| t.kind == Kind::Directive)
        .collect();
    let place = |i: usize| {
        let link = directives[i].link()?;
        directives.iter().position(|d| **d == lexed.tokens[link])
    };
    // if 0, while 1, end 2, else 3, switch 4, case 5, break 6, end 7, end 8, end 9 (one too many), macro 10.
    assert_eq!(place(0), Some(3));
    assert_eq!(place(1), Some(2));
    assert_eq!(place(3), Some(8));
    assert_eq!(place(4), Some(5));
    assert_eq!(place(5), Some(7));
    assert_eq!((place(9), place(10)), (None, None));
}

#[test]
fn lengths_for_carets() {
    let text = b"sphere <= 1.5e3 # include \"ab\"";
    let length = |start: usize| token_length(text.get(start..).unwrap_or(&[]));
    assert_eq!(length(0), 6);
    assert_eq!(length(7), 2);
    assert_eq!(length(10), 5);
    assert_eq!(length(16), 9);
    assert_eq!(length(26), 4);
    assert_eq!(length(999), 1);
}
