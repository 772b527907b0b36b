"""The chapters that compare what was recorded with the fabric files: friction and extension."""
import numpy as np

from . import figures, plots
from .page import Chapter
from .reading import FINGERS

MOST_CLOTHS = 10  # fabrics, factors or sheets of one bag that are shown


def friction(reading):
    made = Chapter('Friction')
    made.say('Friction is the part of the force along the cloth. The loops show what of it is against '
             'the sliding, over the normal force, along weft and along warp: positive while the finger '
             'slides to larger coordinates, negative on the way back. The table takes all of it, where '
             'a finger slides faster than 1 mm/s under more than 0.02 N.')
    rows = []
    for name in FINGERS:
        finger = reading.fingers[name]
        if len(finger.contact) == 0:
            made.lack(f'friction of the {name} ({name}/contact)')
            continue
        for cloth, fabric, *numbers in figures.friction_of(finger):
            files = reading.cloths[cloth].files if cloth >= 0 else []
            file = files[fabric] if fabric < len(files) else None
            known = file.friction() if file else None
            rows.append((name, file.name if file else f'number {fabric}', *numbers,
                         *(known or (np.nan, '-'))))
        made.picture(friction_loop(name, finger, coefficients(reading)),
                     f'{name}: friction over normal force against the place on the fabric; dashed: '
                     'plus and minus the coefficients of the fabric files.')
        table = finger.contact.table()
        made.numbers(f'friction_{name}', ('time (s)', 'normal force (N)', 'friction (N)',
                                          'along weft (N)', 'along warp (N)', 'weft (m)', 'warp (m)',
                                          'speed (m/s)'),
                     table[table[:, 2] > 0.0][:, [0, 2, 3, 8, 9, 6, 7, 10]]
                     - np.array([reading.begin] + 7 * [0.0]))
    header = ('finger', 'fabric', 'samples', 'lower quartile', 'median', 'upper quartile',
              'coefficient of the file', 'provenance')
    if rows:
        made.table(header, rows)
    else:
        made.say('No finger slid.')
    made.numbers('friction', header, rows)
    return made


def coefficients(reading):
    """Of friction, each once, in all the files."""
    return sorted({fabric.friction()[0] for cloth in reading.cloths for fabric in cloth.files
                   if fabric and fabric.friction()})


def friction_loop(name, finger, known):
    table = finger.contact.table()
    table = table[table[:, 2] > figures.PRESSED]
    picture, axes = plots.figure(1, 2, 2.8)
    for place, (column, axis) in enumerate(((6, 'weft'), (7, 'warp'))):
        ratios = table[:, column + 2] / table[:, 2]
        axes[0, place].plot(1e3 * table[:, column], ratios, '.', ms=1.5, color=plots.COLOURS[name],
                            rasterized=True)
        for coefficient in known:
            for sign in (-1, 1):
                axes[0, place].axhline(sign * coefficient, color='#555', ls='--', lw=0.8)
        usual = np.percentile(np.abs(ratios), 99) if len(ratios) > 0 else 0.0
        reach = 1.5 * max([0.1, usual, *known])
        axes[0, place].set(xlabel=f'place along {axis} (mm)', ylabel=f'friction / normal, {axis}',
                           ylim=(-reach, reach))
    return plots.as_uri(picture, 'png')


def extension(reading):
    made = Chapter('Force against extension')
    made.say('Strain: mean over all elements. Force: what the side of the cloth with the largest '
             'coordinate carries along the way from the middle to it, over the width of the cloth. '
             'Cloth that is drawn evenly lies on the curve of its fabric; a pinch or its own weight '
             'draws it unevenly, and the mean of the strains lies beside it.')
    table = figures.extension_of(reading)
    if table is None:
        made.lack('strains (cloth/state with its cloth/mesh)')
        return made
    held = [place for place in (0, 1) if reading.held[place]]
    for place in (0, 1):
        axis = ('weft', 'warp')[place]
        if place in held:
            made.say(f'Along {axis}: strain {100.0 * table[:, 3 + place].min():.4g} to '
                     f'{100.0 * table[:, 3 + place].max():.4g} %, force up to '
                     f'{table[:, 5 + place].max():.4g} N/m.')
        else:
            made.lack(f'a pull along {axis}: nothing holds the side of the cloth there')
    if held:
        made.picture(extension_plot(reading, table, held),
                     'Force per width against mean strain, and the curves of the fabric files.')
    made.numbers('extension', ('time (s)', 'weft strain', 'warp strain', 'weft force (N/m)',
                               'warp force (N/m)', 'cloth'),
                 table[:, [0, 3, 4, 5, 6, 7]] - np.array([reading.begin] + 5 * [0.0]))
    if not any(any(cloth.files) for cloth in reading.cloths):
        made.lack('curves of fabrics (the fabric files in cloth/mesh)')
    return made


def extension_plot(reading, table, held):
    """Of the directions in which the cloth is held; a colour for each cloth."""
    picture, axes = plots.figure(1, len(held), 3.2)
    for axis, place in zip(axes[0], held):
        name = ('weft', 'warp')[place]
        for number in np.unique(table[:, 7]).astype(int)[:MOST_CLOTHS]:
            rows = table[table[:, 7] == number]
            cloth = reading.cloths[number]
            since = f', from {max(0.0, cloth.time - reading.begin):.1f} s' if number else ''
            colour = f'C{number % 10}'
            axis.plot(100.0 * rows[:, 3 + place], rows[:, 5 + place], '.', ms=2, color=colour,
                      label=f'recorded{since}', rasterized=True)
            if cloth.files and cloth.files[0]:
                draw_curve(axis, cloth.files[0], name, cloth.factors[place],
                           rows[:, 3 + place], colour)
        axis.set(xlabel=f'strain along {name} (%)', ylabel='force per width (N/m)',
                 ylim=(min(0.0, 1.1 * table[:, 5 + place].min()),
                       1.1 * max(table[:, 5 + place].max(), 0.1)))
        axis.legend(frameon=False)
    return plots.as_uri(picture, 'png')


def draw_curve(axis, fabric, name, factor, strains, colour):
    """As far as the recording goes; nothing where the file cannot be read."""
    reach = 1.2 * max(strains.max(), 1e-4)
    try:
        curve = fabric.curve_between(name, min(0.0, strains.min()), reach, factor)
    except (KeyError, TypeError, ValueError, IndexError):
        return
    label = f'{fabric.name}, file' + (f', times {factor:g}' if factor != 1.0 else '')
    axis.plot(100.0 * curve[0], curve[1], color=colour, lw=1, label=label)
