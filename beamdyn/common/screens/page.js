// Scripts of an interactive program's page.  `window.programName` is set before.

// What the browser keeps: a tab's page and what is typed in it, named designs, look -----------------------

const nameOf = (what) => `${window.programName}-${what}`;
const kept = (store, what) => JSON.parse(store.getItem(nameOf(what)) || "{}");
const keep = (store, what, value) => store.setItem(nameOf(what), JSON.stringify(value));

// What was stored, the look, the width, and the link in the address, which is taken out of there: as JSON.
window.recallPage = () => {
  const page = kept(sessionStorage, "page");
  page.typed = kept(sessionStorage, "typed");
  page.look = localStorage.getItem(nameOf("look"));
  page.link = location.hash;
  page.narrow = narrowPage.matches;
  if (location.hash) history.replaceState(null, "", location.pathname);
  return JSON.stringify(page);
};
// Stores the content of the page.  The texts of fields that the program has heard, by document and path, need
// no longer be kept as key strokes.
window.rememberPage = (content, heard) => {
  keep(sessionStorage, "page", content);
  const typed = kept(sessionStorage, "typed");
  for (const [name, fields] of Object.entries(heard))
    for (const [path, text] of Object.entries(fields))
      if (typed[name]?.[path] === text) delete typed[name][path];
  keep(sessionStorage, "typed", typed);
};
// Forgets the key strokes, for when another design is shown.
window.forgetTyped = () => sessionStorage.removeItem(nameOf("typed"));
window.keepLook = (look) => localStorage.setItem(nameOf("look"), look);
window.namedDesigns = () => localStorage.getItem(nameOf("designs"));
// Stores a named design, or deletes it where none is given; returns "" or why the browser has no room for it.
window.putDesign = (name, design) => {
  const all = kept(localStorage, "designs");
  if (design) all[name] = design;
  else delete all[name];
  try {
    keep(localStorage, "designs", all);
    return "";
  } catch (error) {
    return "the browser has no room for it: delete another design";
  }
};

// What has been typed, undo and redo, links, width ------------------------------------------------------

// A key stroke in a field is kept until the program has stored it, and its screen is marked until the program
// has heard it (a field tells what is typed after 20 ms, one of a list when it is left).  A link that is put
// into the address of an open page is followed.  The keys of undo and redo are passed on after what has been
// typed, and it is reported when the page becomes narrow or wide.
window.narrowPage = matchMedia("(max-width: 600px)"); // below it drawings have narrow paper, as in page.css
const TOLD = 50; // time after which a field has told what is typed [ms]
const marked = new Set(); // screens marked as typed; those of hidden tabs are not in the document
let strokes = 0;
const askAfter = (delay) => {
  const stroke = ++strokes;
  setTimeout(() => stroke === strokes && emitEvent("typed", stroke), delay);
};
window.heard = (stroke) => {
  if (stroke !== strokes) return;
  for (const screen of marked) screen.classList.remove("typed");
  marked.clear();
};
const askNow = (event) => { if (event.target.closest?.(".typed [data-path]")) askAfter(0); };
document.addEventListener("focusout", askNow);
document.addEventListener("keydown", (event) => { if (event.key === "Enter") askNow(event); });
document.addEventListener("input", (event) => {
  const field = event.target.closest?.("[data-path]"), screen = event.target.closest?.("[data-document]");
  if (!field || !screen || event.target.value === undefined) return;
  const typed = kept(sessionStorage, "typed");
  (typed[screen.dataset.document] ??= {})[field.dataset.path] = event.target.value;
  keep(sessionStorage, "typed", typed);
  const around = field.closest(".screen");
  around.classList.add("typed");
  marked.add(around);
  if (field.closest(".lists")) ++strokes;
  else askAfter(TOLD);
});
narrowPage.addEventListener("change", (event) => emitEvent("narrow", event.matches));
window.addEventListener("hashchange", () => { if (location.hash.length > 1) location.reload(); });
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.closest?.(".q-dialog")) return;
  const key = event.key.toLowerCase();
  const way = key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : "";
  if (!way) return;
  event.preventDefault();
  setTimeout(() => emitEvent(way), TOLD);
});

// While NiceGUI tries to reach the program it shows its element "popup"; these are other words for it.
const notice = document.getElementById("popup");
notice.setAttribute("role", "alert");
notice.textContent = `The program has stopped. Start "${window.programName} app --port ${location.port}" again: `
  + "this page goes on by itself.";

// Changes during a drag ---------------------------------------------------------------------------------

// Writes changes of elements, given by their ids.  Of their content only what differs is replaced, since new
// nodes cost the browser and the toolkit a search for style rules.  A field keeps its text in a property.
const put = (shown, name, value) => shown.getAttribute(name) === value || shown.setAttribute(name, value);
const fill = (shown, wanted) => {
  const there = [...shown.childNodes], nodes = [...wanted.childNodes];
  nodes.forEach((node, i) => i < there.length ? become(there[i], node) : shown.append(node));
  there.slice(nodes.length).forEach((node) => node.remove());
};
const become = (shown, wanted) => {
  if (shown.nodeName !== wanted.nodeName) return shown.replaceWith(wanted);
  if (!wanted.attributes) return shown.data === wanted.data || (shown.data = wanted.data);
  for (const {name} of [...shown.attributes]) if (!wanted.hasAttribute(name)) shown.removeAttribute(name);
  for (const {name, value} of wanted.attributes) put(shown, name, value);
  fill(shown, wanted);
};
const parsed = document.createElement("template");
const ofHiddenTab = (id) => { // kept apart from the document; Vue would not repeat a change that it missed
  const made = getElement(id), shown = made?.$el ?? made;
  return shown instanceof Element ? shown : null;
};
window.writeChanges = (changes) => {
  for (const [id, changed] of Object.entries(changes)) {
    const shown = getHtmlElement(id) ?? ofHiddenTab(id);
    if (shown === null) continue;
    for (const [name, value] of Object.entries(changed)) {
      if (name === "innerHTML") {
        parsed.innerHTML = value;
        fill(shown, parsed.content);
      } else if (name === "text") shown.textContent = value;
      else if (name === "value") {
        Vue.toRaw(getElement(id).$data).inputValue = value;  // for when it is rendered again
        (shown.querySelector("input, textarea") ?? shown).value = value;
      } else if (name === "place") getElement(id).at = value;
      else if (name === "options") {
        // First without series: in one step the media options, which have none, would remove the new series, too.
        const chart = getElement(id).chart;
        chart?.setOption({series: []}, {replaceMerge: ["series"], lazyUpdate: true});
        chart?.setOption(value, {lazyUpdate: true});
      } else put(shown, name, value);
    }
  }
};

// Points of drawings ------------------------------------------------------------------------------------

// Sends the position of a handle in the picture, in parts of its width and height, as the pointer drags it,
// and whether it has been let go; by one listener, so that this message comes last.  The picture's position is
// taken at the start: if a new sentence above shifts the picture, the point does not follow.
window.holdHandle = (down, emit) => {
  if (down.button) return;
  const handle = down.currentTarget, board = handle.parentElement;
  const own = handle.getBoundingClientRect();
  const aside = [down.clientX - own.x - own.width / 2, down.clientY - own.y - own.height / 2];
  const box = board.getBoundingClientRect();
  const send = (event, done) => {
    const part = (at, size) => Math.min(Math.max(at / size, 0), 1);
    emit(part(event.clientX - aside[0] - box.x, box.width),
         part(event.clientY - aside[1] - box.y, box.height), done);
  };
  handle.setPointerCapture(down.pointerId);
  handle.onpointermove = (event) => send(event, false);
  handle.onpointerup = handle.onpointercancel = (event) => {
    handle.onpointermove = handle.onpointerup = handle.onpointercancel = null;
    send(event, true);
  };
};
window.stepHandle = (event, emit) => {
  const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
  if (!way || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  emit(way[0], way[1], event.shiftKey);
};

// Charts ------------------------------------------------------------------------------------------------

// Zooming and moving by keys: each changes the part of the x axis [%] that is shown.
window.zoomChart = (event, id) => {
  const chart = getElement(id)?.chart, zoom = chart?.getOption().dataZoom?.[0];
  if (!zoom || event.ctrlKey || event.altKey || event.metaKey) return;
  const {start, end} = zoom, step = 0.1 * (end - start);
  const to = {"+": [start + step, end - step], "=": [start + step, end - step],
    "-": [start - 1.25 * step, end + 1.25 * step], "0": [0, 100],
    ArrowLeft: [Math.max(start - step, 0), end - Math.min(step, start)],
    ArrowRight: [start + Math.min(step, 100 - end), Math.min(end + step, 100)]}[event.key];
  if (!to) return;
  event.preventDefault();
  chart.dispatchAction({type: "dataZoom", start: Math.max(to[0], 0), end: Math.min(to[1], 100)});
};
// Saves what is seen, on paper: programs that draw and write know neither the page's colours nor its letters.
window.saveChart = (model, api) => {
  const [head, ...seen] = api.getDataURL({excludeComponents: ["toolbox"]}).split(",");
  const picture = decodeURIComponent(seen.join(",")).replace('fill="none"', 'fill="#ffffff"')
    .replace(/var\(--[\w-]+,(#\w+|none)\)/g, "$1")
    .replace(/font-family: ?inherit/g, "font-family:sans-serif");
  const name = model.getComponent("toolbox").get(["feature", "mySave", "name"]);
  const link = Object.assign(document.createElement("a"),
    {href: `${head},${encodeURIComponent(picture)}`, download: `${name}.svg`});
  link.click();
};
