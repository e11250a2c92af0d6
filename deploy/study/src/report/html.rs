//! The few pieces of HTML that the page is made of.

use std::fmt::Write;

/// Text as it may stand in HTML.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A cell: its content, its classes, what is said when one points at it.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    /// HTML.
    pub(super) content: String,
    pub(super) class: &'static str,
    /// Plain text.
    pub(super) hint: String,
}

impl Cell {
    /// Plain text.
    pub(super) fn text(text: impl AsRef<str>) -> Self {
        Self {
            content: escape(text.as_ref()),
            ..Self::default()
        }
    }

    /// HTML as it is.
    pub(super) fn html(content: String) -> Self {
        Self {
            content,
            ..Self::default()
        }
    }
}

/// A table under its head; the head is rows of HTML already.
pub(super) fn table(head: &str, rows: &[Vec<Cell>]) -> String {
    let mut html = format!("<div class=\"wide\"><table><thead>{head}</thead><tbody>");
    for row in rows {
        html.push_str("<tr>");
        for cell in row {
            let hint = match cell.hint.as_str() {
                "" => String::new(),
                hint => format!(" title=\"{}\"", escape(hint)),
            };
            let _ = write!(
                html,
                "<td class=\"{}\"{hint}>{}</td>",
                cell.class, cell.content
            );
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// A row of headings.
pub(super) fn head(titles: &[&str]) -> String {
    let cells = titles
        .iter()
        .map(|title| format!("<th>{}</th>", escape(title)));
    format!("<tr>{}</tr>", cells.collect::<String>())
}

/// A whole page.
pub(super) fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>\n<style>{STYLE}</style>\
         </head>\n<body>\n{body}</body></html>\n",
        escape(title)
    )
}

const STYLE: &str = "\
body{font:15px/1.45 system-ui,sans-serif;max-width:1150px;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.6em}h2{font-size:1.25em;margin-top:2em}table{border-collapse:collapse;font-size:13px}\
td,th{border-bottom:1px solid #ddd;padding:3px 8px;text-align:right;white-space:nowrap}\
td:first-child,th:first-child{text-align:left}th{background:#f4f4f4}\
small{color:#777}.best{color:#087830;font-weight:bold}.worst{color:#b01818;font-weight:bold}\
.like-best{color:#087830}.like-worst{color:#b01818}.wide{overflow-x:auto}\
.claims td{white-space:normal;text-align:left;vertical-align:top}.supported{color:#087830;font-weight:bold}\
.contradicted{color:#b01818;font-weight:bold}.undecided{color:#777;font-weight:bold}figure{margin:1em 0}\
figcaption{color:#555;font-size:13px}svg{max-width:100%;height:auto}";
