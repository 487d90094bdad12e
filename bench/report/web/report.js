"use strict";
// What a report can do beyond being read: choose a comparison, light or dark, copy a command, replay.
(() => {
  const root = document.documentElement;
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];

  const theme = document.getElementById("theme");
  theme.hidden = false;
  theme.addEventListener("click", () => {
    const isDark = root.dataset.theme
        ? root.dataset.theme === "dark"
        : window.matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = isDark ? "light" : "dark";
  });

  // All comparisons are in the page; one is shown.
  const choice = document.getElementById("comparison");
  const articles = all("article.comparison");
  function choose(name) {
    for (const article of articles) article.hidden = article.id !== name;
  }
  if (choice) {
    choice.parentElement.hidden = articles.length < 2;
    choice.addEventListener("change", () => choose(choice.value));
  }

  for (const button of all("button.copy")) {
    button.hidden = false;
    button.addEventListener("click", async () => {
      const code = button.parentElement.querySelector("code");
      try {
        await navigator.clipboard.writeText(code.textContent);
        button.textContent = "copied";
      } catch (error) {  // a page from a disk may not: then it is at least marked
        const range = document.createRange();
        range.selectNodeContents(code);
        getSelection().removeAllRanges();
        getSelection().addRange(range);
        button.textContent = "marked";
      }
    });
  }

  // Three dimensions cost something, so only when they are asked for.
  for (const button of all("button.open-replay")) {
    button.hidden = false;
    button.addEventListener("click", () => {
      const place = document.createElement("div");
      place.tabIndex = -1;
      button.replaceWith(place);
      const data = JSON.parse(document.getElementById(button.dataset.replay).textContent);
      place.sidestepReplay = mountReplay(place, data, {embedded: true, keysOf: place});
    });
  }
})();
