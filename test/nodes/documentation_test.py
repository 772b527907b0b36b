#!/usr/bin/python3
"""Pages that are written from other files, or name them, say what these say."""
import importlib.machinery
import importlib.util
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def reference():
    loader = importlib.machinery.SourceFileLoader('message_reference', str(ROOT / 'scripts/message_reference'))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class Documentation(unittest.TestCase):
    def test_the_reference_of_messages_is_that_of_their_files(self):
        self.assertEqual((ROOT / 'docs/messages.md').read_text('utf-8'), reference().page(),
                         'run scripts/message_reference')

    def test_every_field_of_every_message_and_service_is_explained(self):
        for kind in ('msg', 'srv'):
            for path in sorted((ROOT / kind).iterdir()):
                for part in reference().parts_of(path.read_text('utf-8'))[1]:
                    for _, name, _, comment in part:
                        self.assertTrue(comment, f'{path.name}: {name}')

    def test_a_line_that_is_no_field_is_refused(self):
        with self.assertRaisesRegex(ValueError, 'neither a field nor a constant: float64'):
            reference().parts_of('float64\n')
        with self.assertRaisesRegex(ValueError, 'belongs to no field'):
            reference().parts_of('\n# lost\n')

    def test_pages_link_to_what_is_there(self):
        for page in [*(ROOT / 'docs').glob('*.md'), *ROOT.glob('*.md')]:
            for link in re.findall(r'\]\(([^)#:]+)(?:#[^)]*)?\)', page.read_text('utf-8')):
                self.assertTrue((page.parent / link).exists(), f'{page.name}: {link}')

    def test_what_users_met_has_the_tests_that_the_page_names(self):
        rows = [line.split(' | ') for line in (ROOT / 'docs/complaints.md').read_text('utf-8').splitlines()
                if line.startswith('| ')][2:]
        self.assertGreater(len(rows), 10)
        for met, _, shown in rows:
            file, names = None, 0
            for word in re.findall('`([^`]+)`', shown):
                if '/' in word:
                    file = (ROOT / word).read_text('utf-8')
                    continue
                names += 1
                self.assertRegex(file, rf'(?m)^(    def {word}\(|TEST(_F)?\(\w+, {word}\)|{word}\(\) {{)',
                                 f'{met}: {word}')
            self.assertGreater(names, 0, met)

    @unittest.skipUnless(shutil.which('doxygen'), 'doxygen is not installed')
    def test_doxygen_has_nothing_to_say_of_the_headers(self):
        with tempfile.TemporaryDirectory() as folder:
            text = (ROOT / 'Doxyfile').read_text('utf-8') + f'\nOUTPUT_DIRECTORY = {folder}\n'
            result = subprocess.run(['doxygen', '-'], cwd=ROOT, input=text, check=False, text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual((result.stdout, result.returncode), ('', 0))


if __name__ == '__main__':
    rostest.rosrun('haptex', 'documentation', Documentation)
