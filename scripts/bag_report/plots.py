"""Pictures as data URIs."""
import base64
import io

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

COLOURS = {'index': '#1f6fb4', 'thumb': '#d1651a', 'weft': '#1f6fb4', 'warp': '#d1651a'}
MOST_POINTS = 1500  # of a line: more are drawn as the least and the largest of each piece
plt.rcParams.update({'figure.dpi': 100, 'font.size': 9, 'axes.grid': True, 'grid.alpha': 0.3,
                     'axes.spines.top': False, 'axes.spines.right': False})


def envelope(times, values):
    """Fewer points that show every peak."""
    times, values = np.asarray(times), np.asarray(values)
    if len(times) <= MOST_POINTS:
        return times, values
    pieces = np.array_split(np.arange(len(times)), MOST_POINTS // 2)
    places = np.unique(np.concatenate(
        [[piece[np.nanargmin(np.nan_to_num(values[piece], nan=np.inf))],
          piece[np.nanargmax(np.nan_to_num(values[piece], nan=-np.inf))]] for piece in pieces]))
    return times[places], values[places]


def figure(rows=1, columns=1, height=2.4, **options):
    return plt.subplots(rows, columns, figsize=(8.4, height * rows), squeeze=False,
                        constrained_layout=True, **options)


def as_uri(picture, kind='svg'):
    memory = io.BytesIO()
    picture.savefig(memory, format=kind, metadata={'Date': None} if kind == 'svg' else None)
    plt.close(picture)
    text = base64.b64encode(memory.getvalue()).decode()
    return f'data:image/{"svg+xml" if kind == "svg" else kind};base64,{text}'


def image_uri(picture):
    """Of a Picture of a bag."""
    if picture.kind != 'raw':
        return f'data:image/{picture.kind};base64,{base64.b64encode(picture.data).decode()}'
    message = picture.data
    channels = 1 if message.encoding == 'mono8' else 3
    rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    pixels = rows[:, :message.width * channels].reshape(message.height, message.width, channels)
    if message.encoding == 'bgr8':
        pixels = pixels[:, :, ::-1]
    memory = io.BytesIO()
    plt.imsave(memory, np.repeat(pixels, 3, axis=2) if channels == 1 else
               np.ascontiguousarray(pixels), format='png')
    return f'data:image/png;base64,{base64.b64encode(memory.getvalue()).decode()}'


def time_lines(series, label, spans=()):
    """One line per (name, times, values); `spans` (begin, length) are shaded."""
    picture, axes = figure()
    for name, times, values in series:
        axes[0, 0].plot(*envelope(times, values), lw=0.9, color=COLOURS.get(name), label=name)
    axes[0, 0].set(xlabel='time (s)', ylabel=label)
    if len(spans) > 0:  # one shape, however many they are
        least, largest = axes[0, 0].get_ylim()
        axes[0, 0].broken_barh(spans, (least, largest - least), color='#c00000', alpha=0.4, lw=0,
                               rasterized=True)
    if len(series) > 1:
        axes[0, 0].legend(frameon=False, ncol=len(series))
    return as_uri(picture)


def cloth_views(views, mechanics, begin):
    """The cloth at some moments, coloured by the larger strain."""
    count = len(views)
    picture = plt.figure(figsize=(8.4, 2.9 * -(-count // 3)), constrained_layout=True)
    everything = np.concatenate([positions for _, __, positions in views])
    middle = 0.5 * (everything.max(axis=0) + everything.min(axis=0))
    reach = 0.5 * max(np.ptp(everything, axis=0).max(), 1e-3)
    strains = [mechanics[mesh].largest_strains(positions) for _, mesh, positions in views]
    largest = max(1e-4, max(np.percentile(strain, 99) for strain in strains))
    for place, ((time, mesh, positions), strain) in enumerate(zip(views, strains)):
        axes = picture.add_subplot(-(-count // 3), min(3, count), place + 1, projection='3d')
        faces = Poly3DCollection(positions[mechanics[mesh].triangles], linewidths=0.3)
        colours = plt.cm.viridis(np.clip(strain / largest, 0.0, 1.0))
        faces.set(facecolor=colours, edgecolor=colours)
        axes.add_collection3d(faces)
        axes.set(xlim=middle[0] + np.array([-reach, reach]),
                 ylim=middle[1] + np.array([-reach, reach]),
                 zlim=middle[2] + np.array([-reach, reach]))
        axes.set_title(f'{time - begin:.1f} s', fontsize=9)
        axes.set_box_aspect((1, 1, 1))
        axes.view_init(15, 25)
        axes.set_axis_off()
    scale = plt.cm.ScalarMappable(plt.Normalize(0.0, 100.0 * largest), 'viridis')
    picture.colorbar(scale, ax=picture.axes, shrink=0.6, label='strain (%)')
    return as_uri(picture, 'png')
