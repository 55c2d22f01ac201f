"""results/validation/report.html: one file with figures and tables."""

import html
import math
import re

from .csv_files import check_row
from .paths import RESULTS
from .report_items import Table
from .style import FIGURES

STYLE = '''
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif; color: #1a1a1a;
  background: #fff; max-width: 64rem; margin: 2.5rem auto 4rem; padding: 0 1.25rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.3rem; margin: 3rem 0 .6rem; padding-top: .8rem; border-top: 1px solid #d5d5d5; }
h3 { font-size: 1rem; margin: 1.6rem 0 .5rem; }
p { max-width: 46rem; }
figure { margin: 1.4rem 0; }
figure svg { max-width: 100%; height: auto; }
figcaption, .origin { color: #555; font-size: .88rem; }
.table { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .7rem; text-align: right; white-space: nowrap; }
th { border-bottom: 2px solid #777; vertical-align: bottom; white-space: normal;
  font-weight: 600; }
td { border-bottom: 1px solid #ececec; }
.text { text-align: left; white-space: normal; }
.good { color: #00664a; font-weight: 600; }
.bad { color: #b03a00; font-weight: 600; }
.verdict { font-size: 1.15rem; padding: .7rem 1rem; border-left: .35rem solid; margin: 1.4rem 0;
  background: #f7f7f7; }
summary { cursor: pointer; font-weight: 600; margin: 1.2rem 0 .4rem; }
nav a { margin-right: 1.1rem; white-space: nowrap; }
code { font-size: .9em; }
'''
LONG = 24  # tables with more rows are folded


def text_of(value, form):
    """A cell; what is missing or not a number is a dash."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return '–'
    return html.escape(str(value) if isinstance(value, str) else format(value, form or 'g'))


def cell(value, form):
    classes = ['text'] if isinstance(value, str) else []
    if value in ('FAIL', 'pass'):
        classes.append('bad' if value == 'FAIL' else 'good')
    attribute = f' class="{" ".join(classes)}"' if classes else ''
    return f'<td{attribute}>{text_of(value, form)}</td>'


def table_html(table):
    texts = [bool(table.rows) and isinstance(table.rows[0][i], str)
             for i in range(len(table.columns))]
    head = ''.join(f'<th{" class=text" if text else ""}>{html.escape(name)}</th>'
                   for (name, _), text in zip(table.columns, texts))
    body = '\n'.join('<tr>' + ''.join(cell(value, form)
                                      for value, (_, form) in zip(row, table.columns)) + '</tr>'
                     for row in table.rows)
    block = f'<div class="table"><table>\n<tr>{head}</tr>\n{body}\n</table></div>'
    source = f' <a class="origin" href="{table.name}.csv">{table.name}.csv</a>'
    title = html.escape(table.title)
    if len(table.rows) > LONG:
        return (f'<details><summary>{title} ({len(table.rows)} rows){source}</summary>{block}'
                '</details>')
    return f'<h3>{title}{source}</h3>\n{block}'


def figure_html(figure):
    svg = (FIGURES / f'{figure.name}.svg').read_text(encoding='utf-8')
    svg = re.sub(r'^.*?(?=<svg)', '', svg, flags=re.DOTALL)
    caption = html.escape(figure.caption)
    svg = svg.replace('<svg', f'<svg role="img" aria-label="{caption}"', 1)
    return f'<figure>\n{svg}\n<figcaption>{caption}</figcaption>\n</figure>'


def checks_table(name, title, checks):
    return Table(name, title,
                 [('part', ''), ('case', ''), ('value', '.5g'), ('unit', ''), ('reference', ''),
                  ('error', '+.3g'), ('tolerance', 'g'), ('of error', ''), ('verdict', '')],
                 [check_row(check) for check in checks])


def summary_html(sections, failed_runs):
    checks = [check for section in sections for check in section.checks]
    missed = [check for check in checks if not check.passed]
    good = not missed and not failed_runs
    held = f'{len(checks) - len(missed)} of {len(checks)} tolerances hold'
    runs = f', {len(failed_runs)} runs failed' if failed_runs else ', every run succeeded'
    parts = [f'<p class="verdict {"good" if good else "bad"}">{"PASS" if good else "FAIL"}: '
             f'{held}{runs}.</p>']
    counts = [(s.title, sum(c.passed for c in s.checks), sum(not c.passed for c in s.checks))
              for s in sections if s.checks]
    parts.append(table_html(Table('checks', 'Tolerances by part', [
        ('part', ''), ('hold', 'd'), ('missed', 'd')], counts)))
    if missed:
        parts.append(table_html(checks_table('checks', 'Missed', missed)))
    if failed_runs:
        parts.append(table_html(Table('failed_runs', 'Runs that failed', [
            ('run', ''), ('exit status', 'd'), ('its last line', '')], failed_runs)))
    return '\n'.join(parts)


def section_html(section):
    return '\n'.join([f'<h2 id="{section.name}">{html.escape(section.title)}</h2>',
                      *(f'<p>{paragraph}</p>' for paragraph in section.paragraphs),
                      *map(figure_html, section.figures), *map(table_html, section.tables)])


def write(sections, failed_runs, origin):
    """@param origin  (name, text) of what was run, where and when."""
    links = ''.join(f'<a href="#{s.name}">{html.escape(s.title)}</a> ' for s in sections)
    page = f'''<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Validation of vacuum_gripper_sim</title>
<style>{STYLE}</style>
</head>
<body>
<h1>Validation of vacuum_gripper_sim</h1>
<p class="origin">{"<br>".join(f"{html.escape(n)}: {html.escape(t)}" for n, t in origin)}</p>
{summary_html(sections, failed_runs)}
<nav><p>{links}</p></nav>
{chr(10).join(map(section_html, sections))}
</body>
</html>
'''
    RESULTS.mkdir(parents=True, exist_ok=True)
    path = RESULTS / 'report.html'
    path.write_text(page, encoding='utf-8')
    return path
