"""One HTML file that needs nothing else: pictures and tables are inside of it."""
import base64
import csv
import gzip
import html
import io
import math

MANY = 8  # columns: with more they are narrower
LARGE = 1 << 20  # bytes: a larger table is compressed
STYLE = '''
body{font:15px/1.45 sans-serif;max-width:56rem;margin:2rem auto;padding:0 1rem;color:#222}
h1{font-size:1.6rem;margin-bottom:.2rem} h2{border-bottom:1px solid #bbb;margin-top:2.2rem}
table{border-collapse:collapse;margin:.8rem 0;font-size:.85rem;display:block;overflow-x:auto}
td,th{padding:.15rem .6rem;border-bottom:1px solid #ddd;text-align:right;vertical-align:top}
td:first-child{overflow-wrap:anywhere}
td:first-child,th:first-child,.text td,.text th{text-align:left}
figure{margin:1rem 0} figure img{max-width:100%} figcaption{font-size:.85rem;color:#555}
.missing{background:#fff4e0;border-left:4px solid #e09000;padding:.4rem .8rem}
.many{font-size:.72rem} .many td,.many th{padding:.15rem .3rem}
.csv{font-size:.85rem} nav{font-size:.9rem} pre{overflow-x:auto;background:#f5f5f5;padding:.6rem}
@media print{body{margin:0;max-width:none} h2{break-after:avoid} figure,tr{break-inside:avoid}
table{display:table} .many{font-size:7pt}}
'''


def text_of(value):
    if isinstance(value, float):
        return '-' if math.isnan(value) else f'{value:.4g}'
    return str(value)


class Chapter:
    def __init__(self, title):
        self.title = title
        self.parts = []
        self.lacks = []  # what the bag has not got

    def say(self, text):
        self.parts.append(f'<p>{html.escape(text)}</p>')

    def missing(self, text):
        self.parts.append(f'<p class="missing">{html.escape(text)}</p>')

    def lack(self, text):
        self.lacks.append(text)
        self.missing('Not there: ' + text)

    def table(self, header, rows, text=False):
        cells = ''.join(f'<th>{html.escape(name)}</th>' for name in header)
        body = ''.join('<tr>' + ''.join(f'<td>{html.escape(text_of(value))}</td>' for value in row)
                       + '</tr>' for row in rows)
        kind = ' class="text"' if text else ' class="many"' if len(header) > MANY else ''
        self.parts.append(f'<table{kind}><tr>{cells}</tr>{body}</table>')

    def picture(self, uri, caption):
        self.parts.append(f'<figure><img src="{uri}" alt="{html.escape(caption, quote=True)}">'
                          f'<figcaption>{html.escape(caption)}</figcaption></figure>')

    def quote(self, text):
        self.parts.append(f'<details><summary>whole text</summary><pre>{html.escape(text)}</pre>'
                          '</details>')

    def numbers(self, name, header, rows):
        """A link to the rows as CSV."""
        memory = io.StringIO()
        writer = csv.writer(memory, lineterminator='\n')
        writer.writerow(header)
        writer.writerows([value.item() if hasattr(value, 'item') else value for value in row]
                         for row in rows)
        data, name, kind = memory.getvalue().encode(), name + '.csv', 'text/csv'
        if len(data) > LARGE:
            data, name, kind = gzip.compress(data, 6, mtime=0), name + '.gz', 'application/gzip'
        self.parts.append(f'<p class="csv"><a download="{name}" href="data:{kind};base64,'
                          f'{base64.b64encode(data).decode()}">{name}</a> '
                          f'({len(rows)} rows, {len(data) / 1e3:.1f} kB: {html.escape(", ".join(header))})</p>')


def page(title, subtitle, chapters):
    contents = ' · '.join(f'<a href="#c{i}">{html.escape(chapter.title)}</a>'
                          for i, chapter in enumerate(chapters))
    body = ''.join(f'<h2 id="c{i}">{html.escape(chapter.title)}</h2>' + '\n'.join(chapter.parts)
                   for i, chapter in enumerate(chapters))
    return (f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>'
            f'{html.escape(title)}</title><style>{STYLE}</style></head><body><h1>'
            f'{html.escape(title)}</h1><p>{html.escape(subtitle)}</p><nav>{contents}</nav>{body}'
            '</body></html>\n')
