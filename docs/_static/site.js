// What opens the pages below one in the side bar says so to those who do not see it.
document.addEventListener("DOMContentLoaded", () => {
  for (const summary of document.querySelectorAll(".bd-sidenav summary")) {
    const page = summary.closest("li")?.querySelector("a")?.textContent ?? "";
    summary.setAttribute("aria-label", `pages of ${page}`);
  }
});
