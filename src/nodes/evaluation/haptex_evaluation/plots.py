"""A plot per property: ranks by people over KES values, and real beside virtual samples."""
import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from scipy.stats import rankdata  # noqa: E402

from .kes_values import PROPERTY_UNITS  # noqa: E402
from .protocol import REAL, VIRTUAL  # noqa: E402

LOOKS = {VIRTUAL: ('o', 'tab:blue'), REAL: ('s', 'tab:orange')}
WIDE_RANGE = 20.0  # of KES values: a logarithmic axis
FONT = 8  # points
LETTER, LINE, GAP = 0.58, 1.1, 0.75  # of the font: width and height of a letter, from a point


def label_points(axes, points, font=FONT):
    """Names points, once the axes have their limits: to the left of those on the right, and above
    labels that would be in the way. @param points (text, x, y)"""
    scale = 72.0 / axes.figure.dpi  # of pixels in points
    middle = axes.transAxes.transform((0.6, 0.0))[0] * scale
    taken = []
    for text, x, y in sorted(points, key=lambda point: point[2]):
        across, up = axes.transData.transform((x, y)) * scale
        width = LETTER * font * len(text)
        begin = across - width - GAP * font if across > middle else across + GAP * font
        base = up - 0.4 * LINE * font
        while any(begin < end and begin + width > start and abs(base - other) < LINE * font
                  for start, end, other in taken):
            base += 1.0
        taken.append((begin, begin + width, base))
        axes.annotate(text, (x, y), xytext=(begin - across, base - up), textcoords='offset points',
                      fontsize=font)


def _title(group, between):
    parts = []
    for each in group.correlations:
        if each.between in between and each.rho is not None:
            parts.append(f'{each.between}: rho {each.rho:.2f} [{each.interval[0]:.2f}, '
                         f'{each.interval[1]:.2f}], tau {each.tau:.2f}')
    return '\n'.join(parts)


def _join_kinds(axes, group):
    """A line between the real and the virtual sample of a fabric."""
    for fabric in {fabric for fabric, _ in group.samples}:
        of = [i for i, sample in enumerate(group.samples) if sample[0] == fabric]
        if group.kes[of[0]] is not None:
            axes.plot([group.kes[i] for i in of], group.ranks[of], color='0.8', zorder=0)


def _highest(group):
    """Of each fabric with a KES value the sample of the larger mean rank: name, value and rank."""
    points = {}
    for (fabric, _), value, rank in zip(group.samples, group.kes, group.ranks):
        if value is not None and rank >= points.get(fabric, (0.0, 0.0))[1]:
            points[fabric] = (value, rank)
    return [(fabric, *point) for fabric, point in points.items()]


def _plot_kes(axes, group):
    each_rank = np.array([rankdata(row) for row in group.ratings])
    for kind, (marker, colour) in LOOKS.items():
        chosen = [i for i, sample in enumerate(group.samples)
                  if sample[1] == kind and group.kes[i] is not None]
        if not chosen:
            continue
        x = np.array([group.kes[i] for i in chosen])
        for row in each_rank:
            axes.plot(x, row[chosen], marker, color=colour, alpha=0.25, markersize=3, linewidth=0)
        axes.plot(x, group.ranks[chosen], marker, color=colour, markersize=7, linewidth=0, label=kind)
    _join_kinds(axes, group)
    known = [value for value in group.kes if value is not None]
    if known and min(known) > 0.0 and max(known) > WIDE_RANGE * min(known):
        axes.set_xscale('log')
    axes.margins(x=0.15)
    axes.set_ylim(0.5, len(group.samples) + 0.8)
    axes.set_xlabel(f'{group.property.replace("_", " ")} ({PROPERTY_UNITS[group.property]})')
    axes.set_ylabel('rank by people, mean and of each')
    axes.set_title(_title(group, ('KES - virtual', 'KES - real')), fontsize=9)
    if known:
        axes.legend(loc='lower right', fontsize=FONT)
    else:
        axes.text(0.5, 0.5, 'no KES value in the files of these fabrics', ha='center',
                  transform=axes.transAxes)


def _both_kinds(group):
    """Of each fabric with a real and a virtual sample: name and both mean ranks."""
    of = dict(zip(group.samples, group.ranks))
    return [(fabric, of[fabric, REAL], of[fabric, VIRTUAL]) for fabric, kind in group.samples
            if kind == REAL and (fabric, VIRTUAL) in of]


def _plot_real(axes, group):
    points = _both_kinds(group)
    axes.plot(*np.array([point[1:] for point in points]).T, 'ko')
    ends = [0.5, len(group.samples) + 0.8]
    axes.plot(ends, ends, color='0.7', linewidth=1, zorder=0)
    axes.set(xlim=ends, ylim=ends, aspect='equal', xlabel='mean rank of the real sample',
             ylabel='mean rank of the virtual sample')
    axes.set_title(_title(group, ('real - virtual',)), fontsize=9)


def plot_group(group, folder):
    """Writes PROPERTY.png, PROPERTY_hidden.png for ratings without the picture."""
    has_real = any(each.between == 'real - virtual' for each in group.correlations)
    figure, axes = plt.subplots(1, 1 + has_real, figsize=(6 + 5 * has_real, 5), squeeze=False)
    _plot_kes(axes[0][0], group)
    if has_real:
        _plot_real(axes[0][1], group)
    agreement = f', W {group.agreement.w:.2f}, p {group.agreement.p:.2g}' if group.agreement else ''
    picture = '' if group.with_picture else ', without the picture'
    raters = f'{len(group.raters)} rater' + ('s' if len(group.raters) > 1 else '')
    figure.suptitle(f'{group.property.replace("_", " ").capitalize()}{picture}: {raters}{agreement}')
    figure.tight_layout()
    label_points(axes[0][0], _highest(group))
    if has_real:
        label_points(axes[0][1], _both_kinds(group))
    figure.savefig(folder / f'{group.property}{"" if group.with_picture else "_hidden"}.png', dpi=110)
    plt.close(figure)
