"""Pages read easily: Flesch's reading ease is 50 or more in the mean of all pages, and below 35 on none.

Of Flesch (1948): 206.835 − 1.015 · words/sentences − 84.6 · syllables/words. A syllable is a group of vowels, but a silent e at a word's end.
What stands in a table, a list's item and a paragraph are sentences of their own; code, links' addresses and numbers do not count.
"""

import pathlib
import re
import subprocess
import sys

LEAST, LEAST_MEAN = 35, 50
FEWEST_WORDS = 50  # below it one name decides


def syllables(word):
    groups = len(re.findall(r"[aeiouy]+", word))
    is_silent = re.search(r"[^aeiouyl]es?$|[^aeiouydt]ed$", word) is not None
    return max(1, groups - is_silent)


def prose(page):
    page = re.sub(r"^```.*?^```$|<!--.*?-->", "\n\n", page, flags=re.M | re.S)
    page = re.sub(r"^(    .*|#.*|[|\s:-]+)$", "\n", page, flags=re.M)
    page = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", page)
    page = re.sub(r"`[^`]*`", "", page)
    return re.sub(r"^\s*([-*]|\d+\.|\|) |\|", "\n\n", page, flags=re.M)


def ease(page):
    """None of a page of few words."""
    texts = [text for text in re.split(r"\n\s*\n|(?<=[.!?:;])\s", prose(page)) if re.search(r"[a-z]{2}", text)]
    words = re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])'[a-z]+", "", " ".join(texts).lower()))
    if len(words) < FEWEST_WORDS:
        return None
    return 206.835 - 1.015 * len(words) / len(texts) - 84.6 * sum(map(syllables, words)) / len(words)


def main():
    root = pathlib.Path(sys.argv[1])
    plain = "The cat sat on the mat. It saw a dog, and ran up the tree. " * 5
    hard = "Considerations regarding epistemological characterizations of indeterministic representations necessitate interdisciplinary " * 7
    if not ease(plain) > 90 > 0 > ease(hard):
        sys.exit(f"the score is wrong: {ease(plain):.0f} of short words, {ease(hard):.0f} of long ones")
    listed = subprocess.run(["git", "-C", root, "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout.split()
    scores = {name: ease((root / name).read_text(encoding="utf-8")) for name in listed if not name.startswith("results/reference/")}
    scores = {name: score for name, score in scores.items() if score is not None}
    for name, score in sorted(scores.items(), key=lambda one: one[1]):
        print(f"{score:5.1f}  {name}")
    mean = sum(scores.values()) / len(scores)
    bad = [name for name, score in scores.items() if score < LEAST]
    if bad or mean < LEAST_MEAN:
        sys.exit(f"reading ease {mean:.1f} in the mean, at least {LEAST_MEAN}; below {LEAST}: {', '.join(bad) or 'none'}")


if __name__ == "__main__":
    main()
