// Tables are sorted by a click on a column's head; the contents are folded where they would cover a small screen.
"use strict";
(() => {
  const value = (row, column) => row.cells[column]?.textContent.trim() ?? "";

  function compare(a, b) {
    if (a === "" || b === "") return (a === "") - (b === "");
    const [x, y] = [a, b].map((text) => Number(text.replaceAll(",", "").replace("inf", "Infinity")));
    return Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b, "en", { numeric: true }) : x - y;
  }

  function sort(table, column) {
    const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
    const down = heads[column].getAttribute("aria-sort") === "ascending";
    heads.forEach((head) => head.removeAttribute("aria-sort"));
    heads[column].setAttribute("aria-sort", down ? "descending" : "ascending");
    const rows = [...body.rows].sort((a, b) => {
      const [x, y] = [value(a, column), value(b, column)];
      return x === "" || y === "" ? compare(x, y) : (down ? -1 : 1) * compare(x, y);
    });
    body.append(...rows);
  }

  for (const table of document.querySelectorAll("table.sortable")) {
    if (table.tBodies[0].rows.length < 2) continue;
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      button.addEventListener("click", () => sort(table, column));
      head.append(button);
    });
  }

  const contents = document.querySelector("nav details");
  if (contents && matchMedia("(max-width: 75rem)").matches) contents.open = false;
  contents?.addEventListener("click", (event) => {
    if (event.target.closest("a") && matchMedia("(max-width: 75rem)").matches) contents.open = false;
  });
})();
