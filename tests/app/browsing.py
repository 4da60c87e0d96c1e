"""What a person does on the page of an interactive program in a real browser, and waits for."""

DRAWING = "img.drawing[alt$='drawing of the result']"


def go(page, name):
    """Bring a screen to the front, and wait until it is drawn."""
    page.get_by_role("tab", name=name).click()
    page.wait_for_function(
        "wanted => document.querySelector(wanted)?.naturalWidth > 100",
        arg=f"{DRAWING}[alt^='{name}']",
    )


def drawing(page):
    return page.locator(f"{DRAWING}:visible").get_attribute("src")


def redrawn(page, before):
    """Wait until another drawing is shown."""
    page.wait_for_function(
        "([wanted, before]) => { const it = document.querySelector(wanted); return it && it.src != before }",
        arg=[DRAWING, before],
    )


def kept(page, text):
    """Wait until the browser keeps a text of the design."""
    page.wait_for_function("text => Object.values(sessionStorage).some(v => v.includes(text))", arg=text)


def field(page, label):
    """A field of the screen in front."""
    return page.get_by_label(label, exact=True).locator("visible=true")


def shown(page, text):
    return page.get_by_text(text).locator("visible=true").first
