//! Pieces of HTML.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use renderer::output::OutputError;
use std::path::Path;

/// Text with HTML's special characters escaped.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A picture file as an `<img>` that needs no file, shown with `aspect` = width / height.
pub(crate) fn embedded_image(path: &Path, alt: &str, aspect: Option<f64>) -> Result<String, OutputError> {
    let failed = |source| OutputError::Write { path: path.to_owned(), source };
    let data = STANDARD.encode(std::fs::read(path).map_err(failed)?);
    let style = aspect.map(|a| format!(" style=\"aspect-ratio:{a:.4}\"")).unwrap_or_default();
    Ok(format!("<img alt=\"{}\"{style} src=\"data:image/png;base64,{data}\">", escape(alt)))
}

/// A table of names and values.
pub(crate) fn facts(rows: &[(&str, String)]) -> String {
    let row = |(name, value): &(&str, String)| {
        format!("<tr><th>{}</th><td>{}</td></tr>", escape(name), escape(value))
    };
    format!("<table class=\"facts\">{}</table>", rows.iter().map(row).collect::<String>())
}

/// A table with a heading per column; the first column is text, the others are numbers.
pub(crate) fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let cells = |tag: &str, texts: &mut dyn Iterator<Item = &str>| {
        texts.map(|text| format!("<{tag}>{}</{tag}>", escape(text))).collect::<String>()
    };
    let body: String = rows
        .iter()
        .map(|row| format!("<tr>{}</tr>", cells("td", &mut row.iter().map(String::as_str))))
        .collect();
    let head = cells("th", &mut heads.iter().copied());
    format!(
        "<div class=\"wide\"><table class=\"numbers\"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_break_the_page() {
        assert_eq!(
            facts(&[("a<b", "\"&'".into())]),
            "<table class=\"facts\"><tr><th>a&lt;b</th><td>&quot;&amp;&#39;</td></tr></table>"
        );
    }
}
