"""Pages of the documentation: generated blocks, words, sentences, headings and first paragraphs."""

import re

import pytest

from validation.pages import (
    CODE_BLOCK,
    DOCS,
    GENERATED_BLOCK,
    MOST_WORDS,
    ROOT,
    STORED_TABLE,
    WHOLE,
    count_words,
    pages,
    renew_blocks,
    total_words,
)

SCREEN = 45
"""Lines between two headings, without tables and code, that a reader sees without scrolling far."""
BY_HAND = [page for page in pages() if page.relative_to(DOCS).as_posix() not in WHOLE]
TWO_SENTENCES = re.compile(r"(?<!^\d)(?<!\bal)(?<!Comput)(?<!Dyn)(?<=[a-z0-9)\]`%])\. (?=[A-Z`*])")


def name(page):
    return page.relative_to(DOCS).as_posix()


def prose(page):
    """Lines of a page without code, generated blocks and tables."""
    text = page.read_text(encoding="utf-8")
    for left_out in (GENERATED_BLOCK, STORED_TABLE, CODE_BLOCK):
        text = left_out.sub("", text)
    return [line for line in text.splitlines() if not line.lstrip().startswith("|")]


@pytest.mark.parametrize("page", pages(), ids=name)
def test_generated_blocks_are_those_of_the_stored_results(page):
    text = page.read_text(encoding="utf-8")
    assert renew_blocks(text) == text, "run: python -m validation.pages"


def test_all_pages_together_have_at_most_so_many_words():
    assert total_words() <= MOST_WORDS


@pytest.mark.parametrize("page", pages(), ids=name)
def test_the_first_paragraph_says_who_needs_the_page(page):
    paragraphs = page.read_text(encoding="utf-8").split("\n\n")
    first = paragraphs[1] if "\n" not in paragraphs[0] else paragraphs[0].split("\n", 1)[1]
    assert re.search(r"\b(This page is|These pages are) for ", first), first


@pytest.mark.parametrize("page", BY_HAND, ids=name)
def test_a_line_holds_one_sentence(page):
    lines = [line for line in prose(page) if page.name != "references.md" or not line.startswith("- **")]
    assert [line for line in lines if TWO_SENTENCES.search(line)] == []


@pytest.mark.parametrize("page", BY_HAND, ids=name)
def test_there_is_a_heading_on_every_screen(page):
    since = longest = 0
    for line in prose(page):
        since = 0 if line.startswith("#") else since + bool(line.strip())
        longest = max(longest, since)
    assert longest <= SCREEN


def test_words_leave_out_code_and_tables_of_stored_results():
    text = "# A page\n\nTwo words | - 3.\n\n```console\nmake docs\n```\n\n"
    block = "<!-- {} -->\n\n| a | b |\n\n<!-- end -->\n"
    assert count_words(text) == 5
    assert count_words(text + block.format("generated: shares") + block.format("stored: a.csv")) == 5


@pytest.mark.parametrize("page", BY_HAND, ids=name)
def test_a_stored_block_is_a_table_beside_its_csv(page):
    text = page.read_text(encoding="utf-8")
    assert text.count("<!-- stored: ") + text.count("<!-- generated: ") == text.count("<!-- end -->")
    for file, block in STORED_TABLE.findall(text):
        assert (ROOT / file).suffix == ".csv" and (ROOT / file).is_file()
        assert all(line.startswith("|") for line in block.strip().splitlines())


def test_the_index_names_every_page_once_in_its_table_and_in_its_tree():
    text = (DOCS / "index.md").read_text(encoding="utf-8")
    listed = [name(page).removesuffix(".md") for page in pages() if page.name != "index.md"]
    assert sorted(re.findall(r"\]\(([\w/]+)\.md\) \|", text)) == listed
    assert sorted(re.findall(r"(?m)^(\w+/\w+)$", text)) == sorted([*listed, "api/modules"])


def anchors(page):
    """Slugs of the headings of a page, as GitHub and Sphinx make them."""
    headings = re.findall(r"(?m)^#+ (.+)$", CODE_BLOCK.sub("", page.read_text(encoding="utf-8")))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize(
    "page", [*pages(), ROOT / "README.md", ROOT / "CONTRIBUTING.md"], ids=lambda page: page.stem
)
def test_links_to_headings_hold(page):
    links = re.findall(r"\]\(((?!http)[^)#\s]*)#([^)\s]+)\)", page.read_text(encoding="utf-8"))
    for file, anchor in links:
        assert anchor in anchors(page.parent / file if file else page), f"{file}#{anchor}"


def test_the_map_of_packages_names_each_package_and_module_once():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    block = re.search(r"(?s)<!-- map of packages -->\n(.*?)<!-- end -->", text)[1]
    named = [one for line in block.splitlines()[2:] for one in re.findall(r"`([\w.]+)`", line.split("|")[1])]
    library = [path for path in (ROOT / "facegear").iterdir() if not path.name.startswith("__pycache__")]
    packages = {path.name for path in library if any(path.glob("*.py"))}
    modules = {path.stem for path in library if path.suffix == ".py" and path.stem != "__init__"}
    assert len(named) == len(set(named))
    assert {one.removesuffix(".py") for one in named} == packages | modules
