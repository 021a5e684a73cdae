//! Fields, numbers and brackets of a well-formed RON text, found without the reader's help.

use std::ops::Range;

/// One `name: value` of the text.
#[derive(Debug)]
pub(crate) struct Field {
    /// Names from the outermost in, list items left out: `objects.shape.length`.
    pub(crate) path: String,
    pub(crate) key: Range<usize>,
    pub(crate) value: Range<usize>,
    /// With the comma behind it, if any.
    pub(crate) whole: Range<usize>,
}

/// A number and the path of the field it belongs to.
#[derive(Debug)]
pub(crate) struct Number {
    pub(crate) path: String,
    pub(crate) span: Range<usize>,
}

/// What stands at each byte that is neither blank, comment nor inside a text in quotes.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let is_word = |c: char| c.is_ascii_alphanumeric() || "_+-.".contains(c);
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").unwrap() + 2
        } else if c == '"' {
            let length = rest[1..].find('"').unwrap() + 2;
            tokens.push(at..at + length);
            length
        } else if is_word(c) {
            let length = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            tokens.push(at..at + length);
            length
        } else {
            if !c.is_whitespace() {
                tokens.push(at..at + c.len_utf8());
            }
            c.len_utf8()
        };
        at += length;
    }
    tokens
}

/// All brackets in order.
pub(crate) fn brackets(text: &str) -> Vec<usize> {
    let tokens = tokens(text).into_iter();
    let brackets = tokens.filter(|token| ["(", ")", "[", "]"].contains(&&text[token.clone()]));
    brackets.map(|token| token.start).collect()
}

/// All brackets, commas and colons in order.
pub(crate) fn punctuation(text: &str) -> Vec<usize> {
    let tokens = tokens(text).into_iter();
    let marks = tokens.filter(|token| "()[],:".contains(&text[token.clone()]));
    marks.map(|token| token.start).collect()
}

/// The bracket that closes the one at `open`.
pub(crate) fn closing(text: &str, open: usize) -> usize {
    let mut depth = 0;
    for at in brackets(text).into_iter().skip_while(|&at| at < open) {
        depth += if "([".contains(&text[at..=at]) { 1 } else { -1 };
        if depth == 0 {
            return at;
        }
    }
    panic!("the bracket at {open} is not closed");
}

/// All fields, outer ones before inner ones.
pub(crate) fn fields(text: &str) -> Vec<Field> {
    let tokens = tokens(text);
    let word = |index: usize| tokens.get(index).map_or("", |token| &text[token.clone()]);
    let mut fields = Vec::new();
    let mut open: Vec<(String, usize)> = Vec::new();
    for index in (0..tokens.len()).filter(|&index| word(index + 1) == ":") {
        let (key, first) = (tokens[index].clone(), index + 2);
        let mut last = first;
        // A variant's name may stand before its bracket.
        if ["(", "["].contains(&word(first + 1)) && !["(", "["].contains(&word(first)) {
            last += 1;
        }
        if ["(", "["].contains(&word(last)) {
            let end = closing(text, tokens[last].start);
            last = tokens.iter().position(|token| token.start == end).unwrap();
        }
        let value = tokens[first].start..tokens[last].end;
        open.retain(|&(_, end)| end > key.start);
        open.push((text[key.clone()].to_owned(), value.end));
        let names: Vec<&str> = open.iter().map(|(name, _)| name.as_str()).collect();
        let end = if word(last + 1) == "," {
            tokens[last + 1].end
        } else {
            value.end
        };
        fields.push(Field {
            path: names.join("."),
            whole: key.start..end,
            key,
            value,
        });
    }
    fields
}

/// All numbers.
pub(crate) fn numbers(text: &str) -> Vec<Number> {
    let fields = fields(text);
    let tokens = tokens(text).into_iter();
    let numbers = tokens.filter(|token| text[token.clone()].parse::<f64>().is_ok());
    numbers
        .map(|span| {
            let innermost = fields
                .iter()
                .rev()
                .find(|field| field.value.contains(&span.start));
            Number {
                path: innermost.unwrap().path.clone(),
                span,
            }
        })
        .collect()
}
