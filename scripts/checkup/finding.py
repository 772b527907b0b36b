"""What the doctor finds: one sentence each, how bad it is, and what to do about it."""
import dataclasses

OK = 'ok'
NOTE = 'note'  # worth knowing
WARNING = 'warning'  # it runs, and something is worse or missing
ERROR = 'error'  # it does not run


@dataclasses.dataclass(frozen=True)
class Finding:
    level: str
    subject: str
    text: str
    remedy: str = ''

    def __str__(self):
        head = f'{self.level:8}{self.subject:12}'
        lines = [head + self.text]
        if self.remedy:
            lines += [' ' * len(head) + ('do: ' if i == 0 else '    ') + line
                      for i, line in enumerate(self.remedy.splitlines())]
        return '\n'.join(lines)


def of(subject):
    """@returns functions that make findings of a subject: ok, note, warning, error"""
    def maker(level):
        return lambda text, remedy='': Finding(level, subject, text, remedy)
    return [maker(level) for level in (OK, NOTE, WARNING, ERROR)]


def summary(findings):
    """@returns the last line, and the exit status: 1 if something prevents running"""
    errors, warnings = (sum(finding.level == level for finding in findings)
                        for level in (ERROR, WARNING))
    if errors:
        return f'{errors} prevent running, {warnings} make it worse', 1
    if warnings:
        return f'it runs; {warnings} could be better', 0
    return 'all is well', 0
