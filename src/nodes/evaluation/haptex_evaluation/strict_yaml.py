"""Reads YAML that people write: what is unknown, missing or of another kind is refused by name.

Nothing of a file that is of another kind is told: the path may be anybody's request.
"""
import math
import pathlib
import re

import yaml

from .quoted import LONGEST_QUOTE, quoted


LARGEST = 1 << 18  # bytes of a file, as of those that the nodes in C++ read
MOST_VALUES = 20_000  # an alias counted as what it stands for; of these PyYAML holds some 1 kB each
DEEPEST = 32  # levels of nesting


class UniqueKeys(yaml.SafeLoader):
    """Refuses keys that are there twice, of which the safe loader would keep the last."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if key in seen:
                raise ValueError(f'line {key_node.start_mark.line + 1}: the key {quoted(key)} is there twice')
            seen.add(key)
        return super().construct_mapping(node, deep)


def require_small(text):
    """Reads a text event by event and holds none. @throws ValueError with the line that is too much"""
    values, sizes, opened = 0, {}, []
    for event in yaml.parse(text, yaml.SafeLoader):
        line = f'line {event.start_mark.line + 1}'
        if isinstance(event, yaml.AliasEvent):
            values += sizes.get(event.anchor, 0)
        elif isinstance(event, (yaml.ScalarEvent, yaml.CollectionStartEvent)):
            values += 1
            opened.append((event.anchor, values - 1))
            sizes[event.anchor] = MOST_VALUES  # within itself
        if values > MOST_VALUES:
            raise ValueError(f'{line}: more than {MOST_VALUES} values, an alias counted as what it stands '
                             'for')
        if len(opened) > DEEPEST:
            raise ValueError(f'{line}: nested deeper than {DEEPEST} levels')
        if isinstance(event, (yaml.ScalarEvent, yaml.CollectionEndEvent)):
            anchor, before = opened.pop()
            sizes[anchor] = values - before


def text_of(path):
    """@throws ValueError if the file is larger than LARGEST; then it is not held"""
    with open(path, 'rb') as file:
        content = file.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise ValueError(f'more than {LARGEST} bytes')
    return content.decode('utf-8')


def kind_of(error):
    """Line and kind of a syntax error: PyYAML's words without what they repeat of the file."""
    if not isinstance(error, yaml.MarkedYAMLError):
        return 'is not YAML: it has characters that are not allowed'
    kind = re.sub(r" ?'.*", '', error.problem or '', flags=re.DOTALL)
    return f'line {error.problem_mark.line + 1}: is not YAML: {kind}'


def load(path, keys):
    """@returns the mapping that a file says, which has at least one of the keys
    @throws ValueError naming the file and what is no YAML in it, or how it is too large"""
    try:
        text = text_of(path)
        require_small(text)
        value = yaml.load(text, UniqueKeys)
    except yaml.YAMLError as error:
        raise ValueError(f'{path}: {kind_of(error)}') from error
    except UnicodeDecodeError as error:
        raise ValueError(f'{path}: is not UTF-8') from error
    except (OSError, ValueError) as error:
        raise ValueError(f'{path}: {error}') from error
    if not isinstance(value, dict):
        raise ValueError(f'{path}: must be a mapping with the keys {", ".join(keys)}')
    if value and not any(key in value for key in keys):
        raise ValueError(f'{path}: has none of the keys {", ".join(keys)}')
    return value


def path_of(name, folder):
    """@param name of a file in the folder without .yaml, or the path of one"""
    return pathlib.Path(name) if '/' in name else pathlib.Path(folder) / f'{name}.yaml'


def require_keys(value, where, required, optional=()):
    """@throws ValueError unless `value` is a mapping with all required keys and none beside them"""
    allowed = [*required, *optional]
    if not isinstance(value, dict):
        raise ValueError(f'{where}: {quoted(value)} must be a mapping with the keys {", ".join(allowed)}')
    for key in value:
        if key not in allowed:
            raise ValueError(f'{where}: unknown key {quoted(key)}, allowed are {", ".join(allowed)}')
    for key in required:
        if key not in value:
            raise ValueError(f'{where}: the key {key} is missing')


def text(value, where):
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f'{where}: {quoted(value)} must be a text that is not empty')
    return value.strip()


def one_of(value, where, allowed):
    if value not in allowed:
        raise ValueError(f'{where}: {quoted(value)} is not allowed, allowed are {", ".join(map(str, allowed))}')
    return value


def number(value, where, least=-math.inf, most=math.inf):
    """A finite number from `least` to `most`."""
    if isinstance(value, str):  # YAML 1.1 takes 1e-3 for a text
        try:
            value = float(value)
        except ValueError:
            pass
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f'{where}: {quoted(value)} must be a finite number')
    if not least <= value <= most:
        raise ValueError(f'{where}: {value} must be from {least:g} to {most:g}')
    return value


def texts(value, where, least):
    """A list of at least so many different texts."""
    if not isinstance(value, list) or len(value) < least:
        raise ValueError(f'{where}: {quoted(value)} must be a list of at least {least}')
    result = [text(item, f'{where}[{i}]') for i, item in enumerate(value)]
    for i, item in enumerate(result):
        if item in result[:i]:
            raise ValueError(f'{where}[{i}]: {item[:LONGEST_QUOTE]} is there twice')
    return result
