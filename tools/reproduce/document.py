"""A report as data: sections of paragraphs, tables and figures, written as Markdown, HTML and JSON.

Numbers of tables are not typed in: a Number names the result file and the key that it was read from, so that report.json
lets anyone (a test) look it up again.
"""
import html
import json
import pathlib


def look_up(folder, file, path):
    """The value in a JSON file of the folder at keys and indices separated by slashes."""
    value = json.loads((pathlib.Path(folder) / file).read_text())
    for key in path.split("/"):
        value = value[int(key)] if isinstance(value, list) else value[key]
    return len(value) if isinstance(value, (list, dict)) else value


def written(value, pattern):
    """A number as the report writes it."""
    if value is None:
        return "–"
    if value == float("inf") or (value > 1e6 and "d" not in pattern):
        return "> 10⁶"
    return pattern % value


class Number:
    """A value of a result file: of a list, its length."""

    def __init__(self, folder, file, path, pattern="%.3g"):
        self.value = look_up(folder, file, path)
        self.sources = [{"file": str(file), "path": path}]
        self.pattern = pattern

    @property
    def text(self):
        return written(self.value, self.pattern)

    def formatted(self, pattern):
        other = Number.__new__(Number)
        other.value, other.sources, other.pattern = self.value, self.sources, pattern
        return other


class Ratio(Number):
    """One Number over another; endless where nothing is left below."""

    def __init__(self, above, below, pattern="%.3g"):
        self.value = above.value / below.value if below.value else float("inf")
        self.sources = above.sources + below.sources
        self.pattern = pattern


class Table:
    def __init__(self, columns, caption=""):
        self.columns = columns
        self.caption = caption
        self.rows = []

    def add(self, *cells):
        if len(cells) != len(self.columns):
            raise ValueError(f"{len(cells)} cells for {len(self.columns)} columns")
        self.rows.append(list(cells))


class Figure:
    """Pictures side by side, each with a line below."""

    def __init__(self, width=300):
        self.panels = []
        self.width = width

    def add(self, picture, text):
        self.panels.append((picture, text))


class Section:
    def __init__(self, identifier, title):
        self.identifier = identifier
        self.title = title
        self.parts = []  # ("text" | "note" | "skipped", str) | ("table", Table) | ("figure", Figure)

    def text(self, words):
        self.parts.append(("text", " ".join(words.split())))

    def note(self, words):
        self.parts.append(("note", " ".join(words.split())))

    def skipped(self, what, why):
        self.parts.append(("skipped", f"{what}: {why}"))

    def table(self, columns, caption=""):
        table = Table(columns, caption)
        self.parts.append(("table", table))
        return table

    def figure(self, width=300):
        figure = Figure(width)
        self.parts.append(("figure", figure))
        return figure


def cell_text(cell):
    return cell if isinstance(cell, str) else cell.text


def marked_up(text):
    """Markdown's bold, code and links as HTML."""
    result = html.escape(text)
    for mark, tag in (("**", "b"), ("`", "code")):
        pieces = result.split(mark)
        if len(pieces) % 2 == 0:
            continue
        result = "".join(piece if i % 2 == 0 else f"<{tag}>{piece}</{tag}>" for i, piece in enumerate(pieces))
    return result


class Document:
    def __init__(self, title, introduction):
        self.title = title
        self.introduction = introduction
        self.sections = []

    def markdown(self, pictures=True):
        lines = [f"# {self.title}", ""]
        for paragraph in self.introduction:
            lines += [paragraph, ""]
        for section in self.sections:
            lines += [f"## {section.title}", ""]
            for kind, part in section.parts:
                if kind == "table":
                    lines += self._markdown_table(part)
                elif kind == "figure":
                    if pictures and part.panels:
                        lines += self._markdown_figure(part)
                elif kind == "text":
                    lines += [part, ""]
                elif kind == "note":
                    lines += [f"> {part}", ""]
                else:
                    lines += [f"*Skipped* – {part}", ""]
        return "\n".join(lines).rstrip() + "\n"

    @staticmethod
    def _markdown_table(table):
        lines = [table.caption, ""] if table.caption else []
        lines.append("| " + " | ".join(table.columns) + " |")
        lines.append("|" + "---|" * len(table.columns))
        lines += ["| " + " | ".join(cell_text(cell) for cell in row) + " |" for row in table.rows]
        return lines + [""]

    @staticmethod
    def _markdown_figure(figure):
        head = "| " + " | ".join(f'<img src="{picture}" width="{figure.width}">' for picture, _ in figure.panels) + " |"
        foot = "| " + " | ".join(text for _, text in figure.panels) + " |"
        return [head, "|" + "---|" * len(figure.panels), foot, ""]

    def html(self):
        out = ["<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8">', f"<title>{html.escape(self.title)}</title>",
               "<style>", "body{font:15px/1.45 sans-serif;max-width:1250px;margin:2em auto;padding:0 1em;color:#222}",
               "table{border-collapse:collapse;margin:1em 0}", "td,th{border:1px solid #ccc;padding:.25em .6em;text-align:left}",
               "th{background:#f2f4f7}", "figure{display:inline-block;margin:.4em;vertical-align:top}",
               "figcaption{font-size:13px}", ".note{border-left:4px solid #d8a03a;background:#fdf8ee;padding:.4em .9em;margin:.8em 0}",
               ".skipped{color:#777;font-style:italic}", "nav a{margin-right:1em}", "</style></head><body>",
               f"<h1>{html.escape(self.title)}</h1>"]
        out += [f"<p>{marked_up(paragraph)}</p>" for paragraph in self.introduction]
        out.append("<nav>" + "".join(f'<a href="#{s.identifier}">{html.escape(s.title.split(":")[0])}</a>'
                                     for s in self.sections) + "</nav>")
        for section in self.sections:
            out.append(f'<h2 id="{section.identifier}">{html.escape(section.title)}</h2>')
            for kind, part in section.parts:
                if kind == "table":
                    out += self._html_table(part)
                elif kind == "figure":
                    out += [f'<figure style="width:{part.width}px"><a href="{picture}"><img src="{picture}" '
                            f'width="{part.width}" alt=""></a><figcaption>{marked_up(text)}</figcaption></figure>'
                            for picture, text in part.panels]
                elif kind == "text":
                    out.append(f"<p>{marked_up(part)}</p>")
                elif kind == "note":
                    out.append(f'<p class="note">{marked_up(part)}</p>')
                else:
                    out.append(f'<p class="skipped">Skipped – {marked_up(part)}</p>')
        return "\n".join(out + ["</body></html>"]) + "\n"

    @staticmethod
    def _html_table(table):
        out = [f"<p>{marked_up(table.caption)}</p>"] if table.caption else []
        out.append("<table><tr>" + "".join(f"<th>{marked_up(c)}</th>" for c in table.columns) + "</tr>")
        out += ["<tr>" + "".join(f"<td>{marked_up(cell_text(c))}</td>" for c in row) + "</tr>" for row in table.rows]
        return out + ["</table>"]

    def data(self):
        """For report.json: every cell with where its number was read."""
        sections = []
        for section in self.sections:
            data = {"id": section.identifier, "title": section.title, "tables": [], "pictures": [], "notes": [],
                    "skipped": []}
            for kind, part in section.parts:
                if kind == "table":
                    data["tables"].append({"columns": part.columns,
                                           "rows": [[self._cell(c) for c in row] for row in part.rows]})
                elif kind == "figure":
                    data["pictures"] += [{"file": picture, "text": text} for picture, text in part.panels]
                elif kind in ("note", "skipped"):
                    data[{"note": "notes", "skipped": "skipped"}[kind]].append(part)
            sections.append(data)
        return {"title": self.title, "sections": sections}

    @staticmethod
    def _cell(cell):
        if not isinstance(cell, Number):
            return {"text": cell_text(cell)}
        return {"text": cell.text, "pattern": cell.pattern, "sources": cell.sources}

    def write(self, folder):
        folder = pathlib.Path(folder)
        (folder / "report.md").write_text(self.markdown())
        (folder / "report.html").write_text(self.html())
        (folder / "report.json").write_text(json.dumps(self.data(), indent=1, ensure_ascii=False) + "\n")
