"""Numbers from what was read: rates, losses, dips, friction, extension."""
import numpy as np
from demo_report.series import runs

LONG_GAP = 5.0  # times the median period: a gap
DIP = 0.5  # of the running median: less is a dip
DIP_WINDOW = 0.5  # s, of the running median
DIP_LEAST = 0.05  # N, that the running median has at least
DIP_SHORTEST = 0.005  # s
SLIDING = 1e-3  # m/s: slower is not counted as sliding
PRESSED = 0.02  # N: less is not counted as touching


def rates(arrivals):
    """By topic: count, Hz, ms and numbers lost. `lost` counts what the sequence of the headers lacks."""
    rows = []
    for topic in sorted(arrivals):
        kept = arrivals[topic]
        received, stamps = np.array(kept.received), np.array(kept.stamps)
        stamped = len(stamps) == len(received) and (stamps > 0.0).all()
        times = np.sort(stamps) if stamped else received
        periods = np.diff(times)
        row = {'topic': topic, 'messages': len(received), 'by': 'stamp' if stamped else 'reception',
               'rate': np.nan, 'median': np.nan, 'p99': np.nan, 'longest': np.nan, 'gaps': 0,
               'lost': np.nan, 'late': np.nan, 'backwards': 0}
        if len(periods) > 0:
            span = times[-1] - times[0]
            median = np.median(periods)
            row.update(rate=len(periods) / span if span > 0.0 else np.nan, median=1e3 * median,
                       p99=1e3 * np.percentile(periods, 99), longest=1e3 * periods.max(),
                       gaps=int((periods > max(LONG_GAP * median, 1e-3)).sum()))
        if len(stamps) > 1:
            steps = np.diff(np.array(kept.sequence).astype(np.int64))
            if (steps > 0).all():  # several publishers, or one that began again, count anew
                row['lost'] = int((steps - 1).sum())
            if stamped:
                row['late'] = 1e3 * np.median(received - stamps)
                row['backwards'] = int((np.diff(stamps) < 0.0).sum())
        rows.append(row)
    return rows


def running_median(times, values):
    """Of the medians of 10 ms, over DIP_WINDOW; at the given times."""
    cell = 0.01  # s
    cells = ((times - times[0]) / cell).astype(int)
    order = np.unique(cells)
    medians = np.array([np.median(part) for part in
                        np.split(values, np.searchsorted(cells, order[1:]))])
    half = int(0.5 * DIP_WINDOW / cell)
    begins = np.searchsorted(order, order - half)
    ends = np.searchsorted(order, order + half, side='right')
    smooth = np.array([np.median(medians[begin:end]) for begin, end in zip(begins, ends)])
    return np.interp(times, times[0] + cell * (order + 0.5), smooth)


def dips(times, forces, touching=None):
    """(begin, length, least force, running median there) of each.
    @param touching times (s) and whether the cloth is touched, or none: wherever it is felt"""
    if len(times) < 3:
        return []
    order = np.argsort(times, kind='stable')
    times, forces = times[order], forces[order]
    median = running_median(times, forces)
    low = (forces < DIP * median) & (median > DIP_LEAST)
    if touching is not None:
        places = np.clip(np.searchsorted(touching[0], times, side='right') - 1, 0, None)
        low &= touching[1][places]
    spells = []
    for begin, end in runs(low):
        length = times[min(end, len(times) - 1)] - times[begin]
        if length >= DIP_SHORTEST:
            place = begin + int(np.argmin(forces[begin:end]))
            spells.append((times[begin], length, forces[place], median[place]))
    return spells


def felt_forces(finger):
    """Times and norms of what was felt; none if it was not recorded."""
    if len(finger.felt) == 0:
        return None
    table = finger.felt.table()
    return table[:, 0], np.linalg.norm(table[:, 1:4], axis=1)


def touching(finger):
    if len(finger.contact) == 0:
        return None
    table = finger.contact.table()
    return table[:, 0], table[:, 2] > PRESSED


def friction_of(finger):
    """By cloth (-1 without its cloth/mesh) and fabric, of what slips under force: samples, quartiles of
    friction over normal force."""
    table = finger.contact.table()
    table = table[(table[:, 4] > 0.5) & (table[:, 10] > SLIDING) & (table[:, 2] > PRESSED)]
    result = []
    for cloth, fabric in np.unique(table[:, [11, 5]], axis=0).astype(int):
        rows = table[(table[:, 11] == cloth) & (table[:, 5] == fabric)]
        result.append((cloth, fabric, len(rows),
                       *np.percentile(rows[:, 3] / rows[:, 2], [25, 50, 75])))
    return result


def extension_of(reading):
    """Rows of Reading.cloth whose cloth/mesh is there; none if there are none."""
    table = reading.cloth.table()
    table = table[np.isfinite(table[:, 3:]).all(axis=1)]
    return table if len(table) > 0 else None


def binned(values, by, edges):
    """Medians of values by the bin of another quantity; not a number where there are none."""
    places = np.digitize(by, edges) - 1
    return np.array([np.median(values[places == i]) if (places == i).any() else np.nan
                     for i in range(len(edges) - 1)])
