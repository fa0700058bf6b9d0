//! Sections and tables in Markdown.

/// Takes the lines of a page.
pub type Page<'a> = dyn FnMut(String) + 'a;

/// Begins a section with a sentence about it.
pub fn section(page: &mut Page<'_>, title: &str, about: &str) {
    page(format!("\n## {title}\n\n{about}"));
}

/// Begins a table: the heads of its columns, of which the first has the names of the rows.
pub fn head(page: &mut Page<'_>, columns: &[String]) {
    page(format!("\n| {} |", columns.join(" | ")));
    page(format!("| --- |{}", " ---: |".repeat(columns.len() - 1)));
}

/// A row of a table.
pub fn row(page: &mut Page<'_>, name: &str, cells: &[String]) {
    page(format!("| {name} | {} |", cells.join(" | ")));
}
