"""The page in a headless browser without a network: on a phone, at a desk, in the dark, by keyboard, on paper."""

import json

import pytest
from browser import CHROMIUM, Browser
from report_rows import HOSTILE, curve, full_rows, row, smith_fit

from ratfit.report.document import Cell, Column, Document, Table
from ratfit.report.records import write_report
from ratfit.report.write import write_document

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here: apt-get install chromium")


KEYS = {"Tab": (9,), "Enter": (13, "\r"), "Space": (32, " ")}
SHOWN = (
    "[...[...document.querySelectorAll('th')].map(h => h.getAttribute('aria-sort')), "
    "...[...document.querySelectorAll('td:first-child')].map(d => d.textContent)]"
)


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    opened = Browser(tmp_path_factory.mktemp("profile"))
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write_report(full_rows(), tmp_path_factory.mktemp("report"))[0]


@pytest.fixture(scope="module")
def hostile_page(tmp_path_factory):
    """Every hostile name at once."""
    rows = [
        row(text, fit=smith_fit() | {"name": text, "target": text}, note=text, gamma=None, command=text)
        for text in HOSTILE
    ]
    drawn = row(
        HOSTILE[0], fit=smith_fit() | {"name": HOSTILE[0]}, curve=curve(variable=HOSTILE[1]), backend=HOSTILE[3]
    )
    return write_report([*rows, drawn], tmp_path_factory.mktemp("hostile"))[0]


def luminance(browser, selector, which):
    """The relative luminance of a computed colour, by WCAG 2."""
    text = browser.value(f"getComputedStyle(document.querySelector({json.dumps(selector)})).{which}")
    numbers = [float(n) / 255 for n in text[text.index("(") + 1 : -1].split(",")[:3]]
    red, green, blue = (n / 12.92 if n <= 0.04045 else ((n + 0.055) / 1.055) ** 2.4 for n in numbers)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(browser, selector, which="color"):
    light, dark = luminance(browser, selector, which), luminance(browser, "body", "backgroundColor")
    return (max(light, dark) + 0.05) / (min(light, dark) + 0.05)


@pytest.mark.parametrize("width", [360, 1280])
@pytest.mark.parametrize("name", ["page", "hostile_page"])
def test_no_page_is_wider_than_its_window_and_nothing_is_asked_or_complained_of(browser, request, name, width):
    path = request.getfixturevalue(name)
    browser.open(path, width)
    browser.value("document.querySelectorAll('details').forEach(d => d.open = true)")
    assert browser.value("document.documentElement.scrollWidth") == width
    assert [event["request"]["url"] for event in browser.seen("Network.requestWillBeSent")] == [path.as_uri()]
    assert not browser.seen("Log.entryAdded") and not browser.seen("Runtime.exceptionThrown")
    assert not browser.seen("Runtime.consoleAPICalled")


def test_no_hostile_name_runs_or_loads_anything(browser, hostile_page):
    browser.open(hostile_page)
    assert browser.value("document.title") == "Fits: accuracy and speed"
    assert browser.value("document.scripts.length") == 1
    assert browser.value("document.querySelectorAll('img, iframe, object, embed, link').length") == 0
    names = browser.value("[...document.querySelectorAll('h2')].map(h => h.textContent)")
    assert names[0] == HOSTILE[0]  # as the letters that it is


def test_the_pages_policy_refuses_what_is_put_into_it(browser, page, tmp_path):
    """What would happen if a name were not escaped: the page's own policy stops script and picture."""
    broken = tmp_path / "broken.html"
    evil = "<script>document.title = 'taken'</script><img src='http://evil.example/x.png'>"
    broken.write_text(page.read_text().replace("<main>", f"<main>{evil}", 1))
    browser.open(broken)
    assert browser.value("document.title") == "Fits: accuracy and speed"
    assert all("Content Security Policy" in e["entry"]["text"] for e in browser.seen("Log.entryAdded"))
    assert len(browser.seen("Log.entryAdded")) == 2
    assert browser.value("document.querySelector('#theme').hidden") is False  # the page's own script did run


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_and_figures_can_be_read_in_light_and_in_dark(browser, page, scheme):
    browser.open(page, scheme=scheme)
    assert (luminance(browser, "body", "backgroundColor") < 0.1) == (scheme == "dark")
    for selector in ("body", "a", "figcaption", ".remark", ".aside", ".notes", "th", "pre"):
        assert contrast(browser, selector) >= 4.5, selector
    assert contrast(browser, ".drawing svg text", "fill") >= 4.5
    for number in (1, 2, 3, 4, 5):
        browser.value(f"document.querySelector('.drawing svg').style.color = 'var(--series-{number})'")
        assert contrast(browser, ".drawing svg") >= 3, number  # what WCAG asks of graphics


def test_the_switch_turns_the_page_dark_and_light_again_and_paper_stays_white(browser, page):
    browser.open(page, scheme="light")
    seen = []
    for _ in range(2):
        browser.value("document.getElementById('theme').click()")
        seen.append(luminance(browser, "body", "backgroundColor") < 0.1)
    assert seen == [True, False]
    browser.open(page, scheme="dark", media="print")
    assert luminance(browser, "body", "backgroundColor") == pytest.approx(1)
    assert browser.value("getComputedStyle(document.getElementById('theme')).display") == "none"


def test_print_unfolds_what_is_folded(browser, page):
    browser.open(page)
    folded = "document.querySelectorAll('details:not([open])').length"
    before = browser.value(folded)
    browser.value("dispatchEvent(new Event('beforeprint'))")
    assert before > 0 and browser.value(folded) == 0
    browser.value("dispatchEvent(new Event('afterprint'))")
    assert browser.value(folded) == before


def test_tables_are_sorted_by_number_with_the_keyboard(browser, tmp_path):
    """Numbers as numbers, whatever is shown of them; what has none last either way; names by the numbers in them."""
    cells = {"b10": ("1e2", 100.0), "b9": ("–", None), "a": ("≥ 20", 20.0), "c": ("-3", -3.0), "B1": ("1e-05", 1e-5)}
    rows = tuple((Cell(name), Cell(text, key)) for name, (text, key) in cells.items())
    table = Table((Column("name"), Column("number", numeric=True)), rows)
    browser.open(write_document(Document("t", (table,), ()), tmp_path, "t")[0])
    orders = []
    for keys in ("Tab Tab Tab", "Enter", "Space", "Tab", "Enter", "Enter"):  # the switch, the table's box, its heads
        for key in keys.split():
            browser.press(key if key != "Space" else " ", *KEYS[key])
        orders.append(browser.value(SHOWN))
    given = list(cells)
    assert orders == [
        [None, None, *given],
        ["ascending", None, "a", "B1", "b9", "b10", "c"],
        ["descending", None, "c", "b10", "b9", "B1", "a"],
        ["descending", None, "c", "b10", "b9", "B1", "a"],
        [None, "ascending", "c", "B1", "a", "b10", "b9"],
        [None, "descending", "b10", "a", "B1", "c", "b9"],
    ]


def test_every_sortable_head_and_every_fold_is_reached_with_the_tab_key(browser, page):
    browser.open(page)
    reached = set()
    for _ in range(400):
        browser.press("Tab", 9)
        name = browser.value("document.activeElement.tagName + '|' + document.activeElement.textContent.slice(0, 20)")
        if name.startswith("BODY"):
            break
        reached.add(name.split("|")[0])
    assert {"BUTTON", "SUMMARY", "A"} <= reached
    assert name.startswith("BODY")


@pytest.mark.parametrize("width", [360, 1280])
def test_text_in_figures_is_large_enough_and_does_not_overlap(browser, page, width):
    browser.open(page, width)
    boxes = browser.value(
        "[...document.querySelectorAll('.drawing svg')].filter(s => s.getBoundingClientRect().width).map(s => "
        "[...s.querySelectorAll('text')].map(t => { const b = t.getBoundingClientRect(); "
        "return [t.textContent, b.left, b.top, b.right, b.bottom, "
        "parseFloat(getComputedStyle(t).fontSize) * s.getBoundingClientRect().width / s.viewBox.baseVal.width] }))"
    )
    assert boxes
    for texts in boxes:
        assert min(size for *_, size in texts) >= 9.5
        for k, (one, left, top, right, bottom, _) in enumerate(texts):
            assert left >= 0 and right <= width, one
            for other, left2, top2, right2, bottom2, _ in texts[k + 1 :]:
                apart = right <= left2 + 1 or right2 <= left + 1 or bottom <= top2 + 3 or bottom2 <= top + 3
                assert apart, (one, other)


def test_the_page_reads_the_same_without_its_script(browser, page):
    browser.open(page)
    words = "document.querySelector('main').textContent.replace(/\\s+/g, '')"
    scripted = browser.value(words)
    browser.ask("Emulation.setScriptExecutionDisabled", value=True)
    browser.open(page)
    plain = browser.value(words)
    browser.ask("Emulation.setScriptExecutionDisabled", value=False)
    assert plain == scripted
