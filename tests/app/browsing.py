"""Actions of a person on the page of an interactive program in a real browser."""

DRAWING = ".board[data-words$='drawing of the result']"
CHARTS = ".charts[data-words$='charts of the result']"
PICTURE = f"{DRAWING}, {CHARTS}"


def go(page, name):
    """Bring a screen to the front, and wait until it is drawn."""
    page.get_by_role("tab", name=name).click()
    page.wait_for_function(
        "wanted => [...document.querySelectorAll(wanted)].some(it => it.getBoundingClientRect().width > 100)",
        arg=f"{DRAWING}[data-words^='{name}'], {CHARTS}[data-words^='{name}']",
    )


def drawing(page):
    """Return what identifies the drawing in front, or the charts of a screen that has only these."""
    return in_front(page).get_attribute("data-picture")


def in_front(page):
    """Return the drawing of the screen in front, or its charts if it has only these."""
    return page.locator(PICTURE).locator("visible=true").first


def redrawn(page, before):
    """Wait until another drawing is shown, or other charts."""
    page.wait_for_function(
        "([wanted, before]) => { const it = [...document.querySelectorAll(wanted)].find("
        "it => it.getBoundingClientRect().height > 50);"
        " return it && it.dataset.picture != before; }",
        arg=[PICTURE, before],
    )


def kept(page, text):
    """Wait until the browser has stored a text of the design."""
    page.wait_for_function("text => Object.values(sessionStorage).some(v => v.includes(text))", arg=text)


def field(page, label):
    """Return a field of the screen in front."""
    return page.get_by_label(label, exact=True).locator("visible=true")


def unfold(page, folded, path):
    """Open the folded part of a form, "section" or "rest", that holds the field of an input."""
    around = page.locator(f".{folded}", has=page.locator(f"[data-path='{path}']"))
    around.locator("visible=true").first.locator(".q-item").first.click()


def shown(page, text):
    return page.get_by_text(text).locator("visible=true").first
