"""Style of an interactive program's page: layout by width, colours for light and dark."""

from __future__ import annotations

from beamdyn.common.drawing.svg import page_colours
from beamdyn.common.edge.rendering import STYLE as TABLES
from beamdyn.common.screens.chart_board import STYLE as CHARTS
from beamdyn.common.screens.controls import STYLE as PLAYER
from beamdyn.common.screens.draggable_drawing import STYLE as BOARD
from beamdyn.common.screens.list_editor import STYLE as LISTS
from beamdyn.common.screens.panels import STYLE as PANELS

BLUE, RED = "#0072B2", "#8c1c00"
_BAR = "#005a8c"

# What the toolkit's own styles take for granted of the style sheet that is left out (Tailwind's), and its few
# classes that are used, in the layers that the toolkit has for them.
_BASE = """
@layer base {
  *, ::before, ::after { margin: 0; padding: 0; border: 0 solid; box-sizing: border-box; }
  h1, h2, h3, button, input, select, textarea { font: inherit; letter-spacing: inherit; color: inherit; }
  button, input, select, textarea { background: transparent; border-radius: 0; }
  a { color: inherit; text-decoration: inherit; }
  ol, ul { list-style: none; }
  table { border-collapse: collapse; border-color: inherit; text-indent: 0; }
  sub, sup { font-size: 75%; line-height: 0; position: relative; vertical-align: baseline; }
  sub { bottom: -0.25em; }
  sup { top: -0.5em; }
  img, svg { display: block; vertical-align: middle; }
  html { line-height: 1.5; font-family: system-ui, sans-serif; }
}
@layer utilities {
  .w-full { width: 100%; }
  .grow { flex-grow: 1; }
  .items-center { align-items: center; }
  .justify-between { justify-content: space-between; }
  .gap-0 { gap: 0; }
  .gap-1 { gap: 0.25rem; }
  .gap-2 { gap: 0.5rem; }
}
"""
_COLOURS = """
:root { --soft: #4a4a4a; --edge: #c8c8c8; --wrong: #8c1c00; --careful: #5a4200; --stripe: #f4f4f4;
  --beyond: #6b6b6b; --focus: #0072B2; --note: #ffffff; }
body.body--dark { --soft: #b9bdc3; --edge: #4a5059; --wrong: #ff9c85; --careful: #f0c060; --stripe: #22272d;
  --beyond: #9aa0a8; --focus: #62b8ee; --note: #2b3138;
  background: #16191d;
  /* before those that the page sets as its own style */
  --q-primary: #62b8ee !important; --q-negative: #ff9c85 !important; }
"""
_DARK = """
.shown tbody tr:nth-child(even) { background: var(--stripe); }
.shown .beyond { color: var(--beyond); }
body.body--dark .q-field--outlined .q-field__control:before { border-color: var(--edge); }
body.body--dark .q-card, body.body--dark .q-menu { background: #22272d; }
body.body--dark .q-btn.bg-primary { color: #10202c !important; }
"""
_LAYOUT = f"""
body {{ font-size: 15px; }}
.nicegui-header {{ padding: 0 0.75rem; background: {_BAR} !important; color: white; }}
.nicegui-header h1 {{ font-size: 1.05rem; font-weight: 600; line-height: 1.2; white-space: nowrap;
  margin-right: 0.5rem; }}
.nicegui-header .q-tabs {{ min-width: 0; }}
.nicegui-content {{ padding: 0.25rem 0.75rem 1rem; }}
.q-tab-panels {{ background: transparent; }}
.q-tab-panel {{ padding: 0.5rem 0; }}
.q-tab-panels, .q-tab-panel, .q-panel {{ overflow: visible; }}
.screen {{ display: grid; grid-template-columns: minmax(270px, 330px) minmax(0, 1fr); gap: 1rem;
  width: 100%; }}
.screen h2, .designs h2 {{ font-size: 1.15rem; font-weight: 600; line-height: 1.3; }}
.left {{ position: sticky; top: 44px; align-self: start; max-height: calc(100vh - 52px); overflow-y: auto;
  padding: 4px 6px 4px 4px; flex-wrap: nowrap; }}
.right {{ min-width: 0; container-type: inline-size; }}
.head {{ gap: 0.35rem; width: 100%; }}
.headline {{ display: flex; flex-wrap: wrap; gap: 0.25rem 2rem; margin: 0; }}
.headline div {{ display: flex; flex-direction: column-reverse; }}
.headline dt {{ font-size: 0.85rem; color: var(--soft); }}
.headline dd {{ font-size: 1.5rem; font-weight: 600; line-height: 1.25; margin: 0;
  font-variant-numeric: tabular-nums; }}
.headline .other {{ font-size: 0.85rem; font-weight: 400; color: var(--soft); display: block; }}
.shown .design {{ white-space: normal; }}
.shown {{ display: grid; grid-template-columns: minmax(0, 1fr); gap: 0.5rem 1.5rem; }}
.pictures, .numbers {{ min-width: 0; width: 100%; flex-wrap: nowrap; }}
@container (min-width: 1050px) {{
  .shown {{ grid-template-columns: minmax(0, 1fr) minmax(380px, 38%); }}
}}
.designs {{ width: min(640px, 92vw); max-width: none; }}
.designs h3 {{ font-size: 1rem; font-weight: 600; margin-top: 0.5rem; }}
.design {{ border-top: 1px solid var(--edge); padding: 0.15rem 0; gap: 0.25rem; line-height: 1.3; }}
.section {{ border: 1px solid var(--edge); border-radius: 4px; flex: none; }}
.section .q-item__label {{ font-weight: 600; }}
.section .nicegui-expansion-content {{ gap: 0.5rem; padding: 0.5rem 0.75rem 0.75rem; }}
.left .nicegui-expansion-content {{ display: grid;
  grid-template-columns: repeat(auto-fill, minmax(200px, 1fr)); align-items: start; }}
.section .q-field__messages {{ line-height: 1.25; }}
/* A hint lies over what stands below its field: else that would move when the field is left, from under the
   pointer that is about to click on it. */
.section .q-field:not(.q-field--error) .q-field__bottom {{ position: absolute; top: calc(100% + 2px); left: 0;
  right: 0; z-index: 5; padding: 4px 8px; min-height: 0; border-radius: 4px; background: var(--note);
  color: var(--soft); box-shadow: 0 1px 4px rgb(0 0 0 / 0.35); pointer-events: none; }}
.status {{ font-size: 0.85rem; color: var(--soft); }}
.mistake {{ color: var(--wrong); font-weight: 600; border-left: 4px solid var(--wrong);
  padding-left: 0.5rem; overflow-wrap: anywhere; }}
.mistake:empty {{ display: none; }}
.warning {{ color: var(--careful); border-left: 4px solid #E69F00; padding-left: 0.5rem; }}
/* After a while: an answer that comes soon is painted once. */
.greyed, .typed .shown {{ opacity: 0.45; filter: grayscale(1); transition: opacity 0s 0.3s, filter 0s 0.3s; }}
.greyed.refused, .greyed.refused > * {{ transition: none !important; }}
/* A number that stands first is grey at once, and says why; ".typed" is set by the page at a key stroke. */
.typed .headline dd, .stale .headline dd, .typed .warning, .stale .warning {{ opacity: 0.45; }}
.typed .headline dt::after, .stale .headline dt::after {{ content: " (stale)"; color: var(--careful); }}
.newer {{ display: none; font-size: 0.85rem; color: var(--careful); }}
.typed .newer {{ display: block; }}
.typed .status[role="status"] {{ display: none; }}
.at-field {{ display: none; }}  /* where the form is in sight */
.slider {{ padding: 0 4.5rem; }}
.slider .q-slider__marker-labels {{ white-space: nowrap; }}
.drawing-frame {{ overflow-x: auto; }}
.drawing {{ max-width: 1000px; min-width: 480px; max-height: 72vh; object-fit: contain;
  object-position: left; }}
:focus-visible {{ outline: 3px solid var(--focus); outline-offset: 1px; }}
.q-header :focus-visible {{ outline-color: white; outline-offset: -3px; }}
#popup {{ top: 0; bottom: auto; left: 0; right: 0; margin: 0; padding: 1rem; border: 0; border-radius: 0;
  background: {RED}; color: white; text-align: center; }}
body:has(#popup[aria-hidden="false"]) #app {{ opacity: 0.5; pointer-events: none;
  transition: opacity 0.5s 2s; }}
"""
# On a narrow page: the main results and the picture first, then the form, then the tables.
_NARROW = """
@media (max-width: 1000px) {
  .nicegui-header { flex-wrap: wrap; }
  .nicegui-header .q-tabs { order: 9; width: 100%; }
  .screen { display: flex; flex-direction: column; gap: 0.75rem; }
  .right, .shown { display: contents; }
  .shown.greyed > *, .typed .shown > * { opacity: 0.45; filter: grayscale(1);
    transition: opacity 0s 0.3s, filter 0s 0.3s; }
  .screen > *, .right > *, .shown > * { width: 100%; }
  .head { order: 1; }
  .pictures { order: 2; }
  .left { order: 3; position: static; max-height: none; overflow: visible; padding: 0; }
  .numbers { order: 4; }
  .right > .after { order: 5; }
  .at-field { display: block; }
  .said:has(.mistake) { position: fixed; z-index: 10; left: 0; right: 0; bottom: 0; padding: 0.5rem;
    max-height: 30vh; overflow-y: auto; background: var(--note); box-shadow: 0 0 6px rgb(0 0 0 / 0.4); }
}
@media (max-width: 600px) {
  .board, .drawing { min-width: 0; }
  .board { width: min(100%, 1000px); }  /* drawings below one another are as high as they are */
  .slider { padding: 0 2.5rem; }
  .stroke { padding-bottom: 2rem; }
  .slider .q-slider__marker-labels { white-space: normal; width: 5.2rem; text-align: center;
    font-size: 0.8rem; line-height: 1.15; }
  .headline dd { font-size: 1.25rem; }
  .shown .sentence { min-width: 11rem; }
  .nicegui-content { padding: 0.25rem 0.5rem 1rem; }
  .section .q-btn { min-width: 40px; min-height: 40px; }
  .handle::after { inset: -14px; }
}
"""
STYLE = (
    _BASE + TABLES + BOARD + PLAYER + CHARTS + LISTS + _COLOURS + _LAYOUT + _DARK + _NARROW + PANELS
)  # the later rules count
STYLE += page_colours("body.body--dark", dark=True)
