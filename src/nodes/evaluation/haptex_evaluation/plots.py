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


def _label(axes, text, x, y):
    axes.annotate(text, (x, y), xytext=(6, 5), textcoords='offset points', fontsize=8)


def _title(group, between):
    parts = []
    for each in group.correlations:
        if each.between in between and each.rho is not None:
            parts.append(f'{each.between}: rho {each.rho:.2f} [{each.interval[0]:.2f}, '
                         f'{each.interval[1]:.2f}], tau {each.tau:.2f}')
    return '\n'.join(parts)


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
        for i in chosen:
            _label(axes, group.samples[i][0], group.kes[i], group.ranks[i])
    known = [value for value in group.kes if value is not None]
    if known and min(known) > 0.0 and max(known) > WIDE_RANGE * min(known):
        axes.set_xscale('log')
    axes.margins(x=0.15)
    axes.set_ylim(0.5, len(group.samples) + 0.8)
    axes.set_xlabel(f'{group.property.replace("_", " ")} ({PROPERTY_UNITS[group.property]})')
    axes.set_ylabel('rank by people, mean and of each')
    axes.set_title(_title(group, ('KES - virtual', 'KES - real')), fontsize=9)
    if known:
        axes.legend(loc='best', fontsize=8)
    else:
        axes.text(0.5, 0.5, 'no KES value in the files of these fabrics', ha='center',
                  transform=axes.transAxes)


def _plot_real(axes, group):
    of = dict(zip(group.samples, group.ranks))
    for fabric, kind in group.samples:
        if kind == REAL and (fabric, VIRTUAL) in of:
            axes.plot(of[fabric, REAL], of[fabric, VIRTUAL], 'ko')
            _label(axes, fabric, of[fabric, REAL], of[fabric, VIRTUAL])
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
    figure.savefig(folder / f'{group.property}{"" if group.with_picture else "_hidden"}.png', dpi=110)
    plt.close(figure)
