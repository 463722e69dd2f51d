// SPDX-License-Identifier: GPL-2.0-or-later
// What moves in a report beside the picture itself: the ring on the curve is the frame that the picture shows, a click on the curve
// shows the nearest frame, and what is folded is open on paper.
"use strict";

(function () {
  /** Places of the frames on a chart, pairs of its own units. */
  const placesOf = (chart) => chart.dataset.frames.split(" ").map((pair) => pair.split(",").map(Number));

  addEventListener("masonryframe", (event) => {
    for (const chart of document.querySelectorAll("svg.chart[data-frames]")) {
      const place = placesOf(chart)[event.detail];
      if (!place) continue;
      const ring = chart.querySelector(".now");
      ring.setAttribute("cx", place[0]);
      ring.setAttribute("cy", place[1]);
    }
  });

  addEventListener("DOMContentLoaded", () => {
    for (const chart of document.querySelectorAll("svg.chart[data-frames]"))
      chart.addEventListener("click", async (event) => {
        const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(chart.getScreenCTM().inverse());
        const far = placesOf(chart).map(([x, y]) => Math.hypot(x - at.x, y - at.y));
        const view = await (window.masonryViews || [])[0];
        if (view) view.show(far.indexOf(Math.min(...far)));
      });
  });

  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open], .screen)")].filter((one) => !one.closest(".masonry-view"));
    for (const one of opened) one.open = true;
  });
  addEventListener("afterprint", () => {
    for (const one of opened) one.open = false;
  });
})();
