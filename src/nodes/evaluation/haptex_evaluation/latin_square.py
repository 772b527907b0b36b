"""Orders that are balanced over subjects: Williams 1949, Australian Journal of Scientific Research A 2."""


def williams_rows(count):
    """Rows in which each of 0 to count - 1 stands once in every column, and after every other one
    equally often: `count` rows if that is even, twice as many if it is odd.
    @throws ValueError unless count >= 1"""
    if count < 1:
        raise ValueError(f'count: {count} must be at least 1')
    first = [0]
    low, high = 1, count - 1
    while len(first) < count:  # 0, 1, n-1, 2, n-2, ...
        first.append(low)
        low += 1
        if len(first) < count:
            first.append(high)
            high -= 1
    rows = [[(item + row) % count for item in first] for row in range(count)]
    return rows if count % 2 == 0 else rows + [row[::-1] for row in rows]


def row_of(count, number):
    """The row that a number from 0 picks; they come again after the last."""
    rows = williams_rows(count)
    return rows[number % len(rows)]
