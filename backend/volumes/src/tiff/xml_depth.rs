//! How deep the elements of an XML text lie in each other, found without going into them.

/// The most elements around one, itself included. The parser goes into each by recursion; where this does not
/// understand the text, the parser refuses it.
pub(super) fn depth(text: &str) -> usize {
    let (mut rest, mut depth, mut deepest) = (text, 0usize, 0);
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        // What has its own end, and what ends it.
        let ends = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>"), ("/", ">")];
        if let Some((start, end)) = ends.into_iter().find(|(start, _)| rest.starts_with(start)) {
            depth = if start == "/" { depth.saturating_sub(1) } else { depth };
            rest = rest[start.len()..].split_once(end).map_or("", |(_, after)| after);
            continue;
        }
        let tag = tag_length(rest);
        deepest = deepest.max(depth + 1);
        depth += usize::from(!rest[..tag].ends_with('/'));
        rest = &rest[tag..];
    }
    deepest
}

/// Bytes of a tag before its end; values of attributes may hold such an end.
fn tag_length(text: &str) -> usize {
    let mut quote = None;
    for (at, letter) in text.bytes().enumerate() {
        match (quote, letter) {
            (None, b'>') => return at,
            (None, b'"' | b'\'') => quote = Some(letter),
            (Some(open), _) if open == letter => quote = None,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_counted_and_nothing_else() {
        for (text, deepest) in [
            ("", 0),
            ("<?xml version='1.0'?><a/>", 1),
            ("<a><b/><b/><b><c></c></b></a>", 3),
            ("<a x='/>' y=\"<\"><b z='>'/></a>", 2),
            ("<a><!-- <b><c><d> --><![CDATA[<b><c><d>]]></a>", 1),
            ("<a><b>", 2),
            ("</a></a><b", 1),
        ] {
            assert_eq!(depth(text), deepest, "{text}");
        }
    }
}
