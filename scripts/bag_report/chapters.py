"""What each chapter of a report says. A chapter whose topics are not there says which it lacks."""
import datetime

import numpy as np
import yaml

from . import figures, plots
from .fabric_chapters import MOST_CLOTHS, extension, friction
from .page import Chapter
from .reading import FINGERS

SPEEDS = np.array([0.0, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.4])  # m/s


def all_chapters(opened, reading):
    """In the order of the page. The last says what is missing."""
    chapters = [what_ran(opened, reading), rates_and_losses(reading), forces(reading),
                friction(reading), extension(reading), tactile(reading), faults(reading),
                pictures(reading)]
    lacks = Chapter('What is missing')
    rows = [(chapter.title, text) for chapter in chapters for text in chapter.lacks]
    if opened.cut_off:
        rows.insert(0, ('the end of the recording', 'the bag was cut off: it had no index. What is '
                                                    'shown ends with its last whole chunk'))
    if reading.damage:
        rows.insert(0, ('the rest of the recording', f'after {reading.end_read - reading.begin:.1f} s of '
                        f'{reading.end - reading.begin:.1f} s the bag is damaged ({reading.damage})'))
    rows += [(topic, f'{count} messages could not be read: {why}')
             for topic, (count, why) in sorted(reading.unreadable.items())]
    rows += [(topic, f'{count} messages with numbers that are not finite were left out')
             for topic, count in sorted(reading.not_finite.items())]
    if rows:
        lacks.table(('of', 'what is not there'), rows, text=True)
    else:
        lacks.say('Nothing: every chapter had its topics.')
    return [*chapters, lacks]


def date_of(seconds):
    moment = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc)
    return moment.strftime('%Y-%m-%d %H:%M:%S UTC')


def what_ran(opened, reading):
    made = Chapter('What ran')
    rows = [('bag', f'{opened.path}, {opened.size / 1e6:.1f} MB'),
            ('recorded', f'{date_of(reading.begin)}, {reading.end - reading.begin:.1f} s'),
            ('compression', opened.compression),
            ('whole', 'no: cut off, its index was made anew' if opened.cut_off else
             'no: damaged' if reading.damage else 'yes')]
    about = about_of(reading)
    for key, name in (('scene', 'scene'), ('version', 'version of haptex'), ('commit', 'commit'),
                      ('host', 'machine')):
        if key in about:
            rows.append((name, str(about[key])))
    for cloth in reading.cloths[:MOST_CLOTHS]:
        rows += rows_of(cloth, reading.begin)
    if len(reading.cloths) > MOST_CLOTHS:
        rows.append(('then', f'{len(reading.cloths) - MOST_CLOTHS} other fabrics, factors or sheets'))
    for time, name, cycle, _ in reading.qualities:
        rows.append((f'quality from {time - reading.begin:.1f} s', f'{name}, {cycle:.2f} ms a cycle'))
    made.table(('', ''), rows, text=True)
    if not about:
        made.lack('scene and versions (recording/about, which the launch files record)')
    elif 'scene_file' in about:
        made.quote(str(about['scene_file']))
    if not reading.cloths:
        made.lack('size, mass and fabrics of the cloth (cloth/mesh)')
    if not reading.qualities:
        made.say('The quality is as the scene file says: cloth/quality was not recorded, which is there '
                 'with a quality or a budget only.')
    fabrics = {file.name: file for cloth in reading.cloths for file in cloth.files if file}
    for name, fabric in fabrics.items():
        made.say(f'Fabric {name}: which properties were measured, and which are representative.')
        made.table(('property', 'provenance'), sorted(fabric.provenances().items()), text=True)
    return made


def rows_of(cloth, begin):
    """What a Cloth is."""
    numbers, since = cloth.mechanics, f' from {max(0.0, cloth.time - begin):.1f} s'
    rows = [('cloth' + since, f'{numbers.count} particles, {len(numbers.triangles)} triangles, '
                              f'{numbers.size[0]:.3f} m along weft, {numbers.size[1]:.3f} m along '
                              f'warp, {1e3 * numbers.mass:.2f} g'),
            ('fabrics' + since, ', '.join(cloth.fabrics))]
    names = ('weft', 'warp', 'shear', 'bending', 'areal density')
    changed = [f'{name} {factor:g}' for name, factor in zip(names, cloth.factors) if factor != 1.0]
    if changed:
        rows.append(('factors' + since, ', '.join(changed)))
    return rows


def about_of(reading):
    try:
        about = yaml.safe_load(reading.about) if reading.about else {}
    except yaml.YAMLError:
        return {}
    return about if isinstance(about, dict) else {}


def rates_and_losses(reading):
    made = Chapter('Rates and losses')
    made.say('By the stamps of the messages, or where they have none by when the recorder had them. A '
             'gap is longer than five median periods. Lost: what the numbers in the headers jump '
             'over; - where several nodes publish, or one began anew. Latency: from the stamp to the '
             'recorder, median. Back: stamps before the one before.')
    header = ('topic', 'messages', 'by', 'rate (Hz)', 'median (ms)', 'p99 (ms)', 'longest (ms)',
              'gaps', 'lost', 'latency (ms)', 'back')
    rows = [tuple(row.values()) for row in figures.rates(reading.arrivals)]
    made.table(header, rows)
    made.numbers('rates', header, rows)
    if len(reading.cloth) > 1:
        table = reading.cloth.table()
        elapsed, simulated = table[-1, 0] - table[0, 0], table[-1, 2] - table[0, 2]
        if elapsed > 0.0 and simulated > 0.0:
            made.say(f'The cloth went on by {simulated:.2f} s in {elapsed:.2f} s: a real-time factor '
                     f'of {simulated / elapsed:.3f}.')
    return made


def forces(reading):
    made = Chapter('Forces and dips')
    made.say('A dip: in contact with the cloth, the force on a finger is below half of its running '
             'median (over 0.5 s, at least 0.05 N) for 5 ms or longer.')
    found, lines, spells = [], [], []
    for name in FINGERS:
        finger = reading.fingers[name]
        felt = figures.felt_forces(finger)
        if felt is None and len(finger.contact) > 0:
            table = finger.contact.table()
            felt = table[:, 0], table[:, 1]
            made.missing(f'{name}: what was felt ({name}/measured_cf) is not there; shown is what '
                         'the contact asked for')
        if felt is None:
            made.lack(f'forces of the {name} ({name}/measured_cf, {name}/contact)')
            continue
        finite = np.isfinite(felt[1])
        times, norms = felt[0][finite], felt[1][finite]
        if len(times) == 0:
            continue
        lines.append((name, times - reading.begin, norms))
        dips = figures.dips(times, norms, figures.touching(finger))
        spells += [(begin - reading.begin, length) for begin, length, _, __ in dips]
        found += [(name, begin - reading.begin, 1e3 * length, least, median)
                  for begin, length, least, median in dips]
        made.say(f'{name}: largest {norms.max():.3f} N, {len(dips)} dips'
                 + (f', {1e3 * sum(dip[1] for dip in dips):.0f} ms in all' if dips else '') + '.')
        made.numbers(f'forces_{name}', ('time (s)', 'force (N)'),
                     np.column_stack([times - reading.begin, norms]))
    if lines:
        made.picture(plots.time_lines(lines, 'force (N)', spells),
                     'Force on each fingertip; dips are shaded.')
    header = ('finger', 'begin (s)', 'length (ms)', 'least (N)', 'running median (N)')
    if found:
        made.table(header, found[:40])
    made.numbers('dips', header, found)
    return made


def tactile(reading):
    made = Chapter('Tactile amplitudes')
    lines, rows = [], []
    for name in FINGERS:
        finger = reading.fingers[name]
        if len(finger.tactile) == 0:
            made.lack(f'contactors of the {name} ({name}/tactile)')
            continue
        table = finger.tactile.table()
        table = table[np.isfinite(table).all(axis=1)]
        lines += [(f'{name}, {frequency} Hz', table[:, 0] - reading.begin, table[:, column])
                  for frequency, column in ((40, 1), (320, 3))]
        pressed = table[table[:, 6] > figures.PRESSED]
        for low, high, slow, fast in zip(SPEEDS, SPEEDS[1:],
                                         figures.binned(pressed[:, 1], pressed[:, 5], SPEEDS),
                                         figures.binned(pressed[:, 3], pressed[:, 5], SPEEDS)):
            if not np.isnan(slow):
                rows.append((name, 1e3 * low, 1e3 * high, slow, fast))
        made.numbers(f'tactile_{name}', ('time (s)', 'mean of 40 Hz (um)', 'largest of 40 Hz (um)',
                                         'mean of 320 Hz (um)', 'largest of 320 Hz (um)',
                                         'speed (m/s)', 'normal force (N)'),
                     table - np.array([reading.begin] + 6 * [0.0]))
    if not lines:
        return made
    made.picture(plots.time_lines(lines, 'mean amplitude (um)'),
                 'Mean over the 24 contactors, at both frequencies.')
    header = ('finger', 'from (mm/s)', 'to (mm/s)', '40 Hz (um)', '320 Hz (um)')
    made.say('Spectrum by speed over the fabric: medians of the mean amplitudes while it is touched.')
    made.table(header, rows)
    made.numbers('tactile_by_speed', header, rows)
    made.picture(contactor_maps(reading),
                 'Mean amplitude of each contactor (um) while the fabric is touched.')
    return made


def contactor_maps(reading):
    picture, axes = plots.figure(1, 4, 2.2)
    place = 0
    for name in FINGERS:
        finger = reading.fingers[name]
        for channel, frequency in enumerate((40, 320)):
            amplitudes = finger.contactors[channel] / max(finger.contactor_time, 1e-9)
            shown = axes[0, place].imshow(amplitudes.reshape(4, 6), origin='lower', cmap='magma')
            axes[0, place].set_title(f'{name}, {frequency} Hz', fontsize=9)
            axes[0, place].set(xticks=[], yticks=[])
            axes[0, place].grid(False)
            picture.colorbar(shown, ax=axes[0, place], shrink=0.7)
            place += 1
    return plots.as_uri(picture)


def faults(reading):
    made = Chapter('Faults')
    states = [(time - reading.begin, what, text) for time, what, text in reading.states]
    header = ('time (s)', 'of', 'state')
    if states:
        made.table(header, states, text=True)
    else:
        made.lack('states of the device (exoskeleton/operating_state)')
    made.numbers('states', header, states)
    rows = [(first - reading.begin, last - reading.begin, count, kind, name, text)
            for (name, kind, _), (first, last, count, text) in
            sorted(reading.troubles.items(), key=lambda item: item[1][0])]
    header = ('first (s)', 'last (s)', 'times', 'level', 'who', 'what')
    if rows:
        made.table(header, rows[:60], text=True)
        if len(rows) > 60:
            made.say(f'{len(rows) - 60} more are in the CSV.')
    elif any(name == 'diagnostic_msgs/DiagnosticArray' for name in reading.types.values()):
        made.say('No node warned.')
    if 'diagnostic_msgs/DiagnosticArray' not in reading.types.values():
        made.lack('warnings of the nodes (/diagnostics)')
    made.numbers('warnings', header, rows)
    return made


def pictures(reading):
    made = Chapter('Pictures')
    for picture in reading.pictures:
        made.picture(plots.image_uri(picture),
                     f'{picture.topic} at {picture.time - reading.begin:.1f} s')
    if not reading.pictures:
        made.say('No camera was recorded (sensor_msgs/Image, sensor_msgs/CompressedImage).')
    if reading.views:
        made.picture(plots.cloth_views(reading.views, reading.mechanics, reading.begin),
                     'The cloth, drawn from cloth/mesh and cloth/state, coloured by the larger of '
                     'its strains along weft and warp.')
    else:
        made.lack('the shape of the cloth (cloth/state with its cloth/mesh)')
    return made
