"""How messages repeat values that came from outside: from files, parameters and requests."""
LONGEST_QUOTE = 200  # characters


def quoted(value):
    """The value as Python writes it, of a longer one the begin and how many characters there are."""
    text = repr(value[:LONGEST_QUOTE]) if isinstance(value, str) else repr(value)
    length = len(value) if isinstance(value, str) else len(text)
    if length <= LONGEST_QUOTE and len(text) <= LONGEST_QUOTE + 2:  # 2: the quotes
        return text
    return f'{text[:LONGEST_QUOTE]}... ({length} characters)'
