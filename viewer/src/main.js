// Fills every place that the report keeps for a 3D view, when it comes near the window. Where there is
// no WebGL 2 the places say so and the pictures below stay what there is.
import { sharedRenderer } from "./stage.js";
import style from "./style.css";
import { Viewer } from "./viewer.js";

function blocksOf(root) {
  const all = document.querySelectorAll(`script[data-viewer="${root.id}"]`);
  return [...all].map((script) => script.textContent);
}

function say(root, text) {
  const paragraph = document.createElement("p");
  paragraph.className = "facts";
  paragraph.textContent = text;
  root.replaceChildren(paragraph);
}

function whatIsMissing() {
  if (typeof DecompressionStream === "undefined") return "a newer browser";
  if (!document.createElement("canvas").getContext("webgl2")) return "WebGL 2";
  try {
    sharedRenderer();
    return null;
  } catch {
    return "WebGL 2";
  }
}

async function fill(root) {
  try {
    const viewer = await Viewer.open(root, blocksOf(root));
    root.classList.add("v-live");
    viewer.invalidate();
  } catch (error) {
    console.error(error);
    say(root, `The 3D view could not be shown (${error.message}); the pictures below show the same.`);
  }
}

function start() {
  const roots = [...document.querySelectorAll(".viewer")];
  if (roots.length === 0) return;
  const missing = whatIsMissing();
  if (missing) {
    for (const root of roots)
      say(root, `The 3D view needs ${missing}; the pictures below show the same.`);
    return;
  }
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  const observer = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        if (!isIntersecting) continue;
        observer.unobserve(target);
        fill(target);
      }
    },
    { rootMargin: "600px" },
  );
  for (const root of roots) {
    root.classList.add("v-place");
    observer.observe(root);
  }
}

start();
