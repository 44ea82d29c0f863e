# SPDX-License-Identifier: MIT
"""Scenes of nonsense: a scene that works with some of its text replaced by a grammar's choice, or groups and keys
thrown together.

The grammar is what `mud_host --template` prints: its groups, keys, words and ranges of numbers. Every scene hangs
on its number alone.
"""
import random
import re

NUMBERS = ("0", "-0.0", "1", "-1", "2", "3", "7", "0.5", "1e-3", "1e3", "-1e-9", "1e9", "1e30", "-1e30", "1e308",
           "1e-320", "1e400", "nan",
           "inf", "-inf", "1e", "--1", "1.2.3", "2**3", "3*1.0", "1000*1", "0x10", "1d0", "99999999999",
           "2147483648", "yes", "'word'", "", "/", "&", "!", "=")
WORDS = ("''", "'all'", "'none'", "'yes'", "'no'", "'maybe'", "'u_z'", "'p_w'", "'p_c'", "'top'",
         "'left'", "'sand'", "'dynamic'", "'static'", "'é'",
         "'../../etc'", "'" + 300 * "x" + "'", "'unclosed", '"double"', "1", "nan", "'a' 'b'", "'a', 'b'", "word")


class Grammar:
    """Groups with their keys, and the words that a key takes, from the template."""

    def __init__(self, template):
        self.groups, self.words = {}, {}
        name = None
        for line in template.splitlines():
            if line.startswith("&"):
                name = line[1:].split()[0]
                self.groups[name] = []
            elif found := re.match(r"\s+!?\s*(\w+)\s*=\s*(\S*)\s*!\s*(.*)", line):
                key, _, told = found.groups()
                self.groups[name].append(key)
                options = told.split(":")[0]
                if "|" in options:
                    self.words[name, key] = [f"'{word.strip()}'" for word in options.split("|")]

    def value(self, dice, name, key):
        own = self.words.get((name, key))
        if own and dice.random() < 0.7:
            return dice.choice(own)
        return dice.choice(NUMBERS if dice.random() < 0.6 else WORDS)

    def group(self, dice):
        name = dice.choice(list(self.groups))
        keys = dice.sample(self.groups[name], min(len(self.groups[name]), dice.randint(0, 6)))
        return f"&{name} " + " ".join(f"{key} = {self.value(dice, name, key)}" for key in keys) + " /\n"

    def scene(self, number, bases):
        """The text of scene `number`: one in eight is thrown together, the others are one of `bases` with odd numbers
        or mistakes."""
        dice = random.Random(number)
        if dice.random() < 0.125:
            return "".join(self.group(dice) for _ in range(dice.randint(0, 12)))
        text = dice.choice(bases)
        if dice.random() < 0.5:   # accepted without a message: only the values are odd
            for _ in range(dice.choice((1, 1, 2, 3))):
                text = self.odd_number(dice, text)
            return text
        for _ in range(dice.choice((1, 1, 1, 2, 3, 8))):
            text = self.mistake(dice, text)
        return text

    def odd_number(self, dice, text):
        """A number of the scene times a power of ten, of either sign, or nothing."""
        found = dice.choice(list(re.finditer(r"(?<=[=\s,])-?\d+\.?\d*(?:[eE][-+]?\d+)?(?=[\s,/])", text)))
        value = float(found[0]) * dice.choice((-1, 0, 1, 1, 1, 1)) * 10.0 ** dice.choice((-9, -3, -1, 1, 1, 3, 6))
        whole = "." not in found[0] and "e" not in found[0].lower()
        odd = str(int(value)) if whole and abs(value) >= 1 else f"{value:g}"
        return text[:found.start()] + odd + text[found.end():]

    def mistake(self, dice, text):
        lines = text.splitlines(keepends=True)
        at = dice.randrange(len(lines)) if lines else 0
        kind = dice.randrange(9)
        assignments = list(re.finditer(r"(\w+)(\s*=\s*)([^!/\n]+?)(?=\s+\w+\s*=|\s*[!/\n])", text))
        if kind <= 3 and assignments:   # another value
            found = dice.choice(assignments)
            before = re.findall(r"&(\w+)", text[:found.start()])
            value = self.value(dice, before[-1] if before else "", found[1])
            return text[:found.start(3)] + value + text[found.end(3):]
        if kind == 4 and lines:         # a line is lost, or comes twice
            return "".join(lines[:at] + lines[at:at + 1] * dice.choice((0, 2)) + lines[at + 1:])
        if kind == 5:                   # one more group
            return "".join(lines[:at]) + self.group(dice) + "".join(lines[at:])
        if kind == 6 and text:          # cut short
            return text[:dice.randrange(len(text))]
        if kind == 7 and text:          # one other character
            place = dice.randrange(len(text))
            return text[:place] + dice.choice("&/='\"!,*. \t\n\0é0a-") + text[place + 1:]
        name = dice.choice(list(self.groups))
        return text.replace("/", f" {dice.choice(self.groups[name] or ['x'])} = {dice.choice(NUMBERS)} /", 1)
