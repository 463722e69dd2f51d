// SPDX-License-Identifier: GPL-2.0-or-later
// What moves in a report beside the picture itself: the ring on the curve is the frame that the picture shows, a click on the curve
// shows the nearest frame, and what is folded is open on paper.
"use strict";

addEventListener("DOMContentLoaded", () => {
  for (const figure of document.querySelectorAll("figure[data-frames]")) {
    const drawing = figure.querySelector("svg");
    const places = figure.dataset.frames.split(" ").map((pair) => pair.split(",").map(Number));
    const ring = document.createElementNS(drawing.namespaceURI, "circle");
    ring.setAttribute("class", "now");
    ring.setAttribute("r", 5);
    drawing.append(ring);
    addEventListener("masonryframe", ({ detail }) => ["cx", "cy"].forEach((name, k) => ring.setAttribute(name, places[detail][k])));
    drawing.addEventListener("click", async (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawing.getScreenCTM().inverse());
      const far = places.map(([x, y]) => Math.hypot(x - at.x, y - at.y));
      const view = await (window.masonryViews || [])[0];
      if (view) view.show(far.indexOf(Math.min(...far)));
    });
  }
});

let opened = [];
addEventListener("beforeprint", () => {
  opened = [...document.querySelectorAll("details:not([open], .screen)")].filter((one) => !one.closest(".masonry-view"));
  for (const one of opened) one.open = true;
});
addEventListener("afterprint", () => opened.forEach((one) => { one.open = false; }));
