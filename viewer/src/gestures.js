// Mouse, touch and keys on the canvas. One finger or the left button turns, two fingers or the right
// button (or Shift) shift, pinching or the wheel magnifies. The wheel scrolls the page until the view
// has the focus, so that nobody gets stuck in it.
export function listen(canvas, orbit, { changed, hovered, chosen, key }) {
  const pointers = new Map();
  let travelled = 0;

  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
    if (pointers.size === 1) travelled = 0;
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse") hovered(event.offsetX, event.offsetY);
      return;
    }
    const now = at(event);
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    travelled += Math.abs(dx) + Math.abs(dy);
    if (pointers.size === 1) {
      if (event.shiftKey || event.buttons & 6) orbit.shift(dx, dy);
      else orbit.turn(dx, dy);
    } else if (pointers.size === 2) {
      pinch(event, before, now);
    }
    pointers.set(event.pointerId, now);
    changed();
  });

  function pinch(event, before, now) {
    const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
    const distance = (p) => Math.hypot(p.x - other.x, p.y - other.y);
    orbit.shift((now.x - before.x) / 2, (now.y - before.y) / 2);
    if (distance(before) > 0 && distance(now) > 0)
      orbit.magnify(distance(now) / distance(before));
  }

  for (const name of ["pointerup", "pointercancel"])
    canvas.addEventListener(name, (event) => {
      const isClick = pointers.size === 1 && travelled < 6 && name === "pointerup";
      pointers.delete(event.pointerId);
      if (isClick && event.button === 0) chosen(event.offsetX, event.offsetY);
    });

  canvas.addEventListener("pointerleave", () => hovered(null, null));

  canvas.addEventListener(
    "wheel",
    (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      const width = canvas.dataset.panes === "2" ? canvas.clientWidth / 2 : canvas.clientWidth;
      const x = (event.offsetX % width) - width / 2;
      orbit.magnify(
        Math.exp(-event.deltaY * lines * 0.0015),
        x,
        event.offsetY - canvas.clientHeight / 2,
      );
      changed();
    },
    { passive: false },
  );

  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (!move(event) && !key(event.key)) return;
    event.preventDefault();
    changed();
  });

  function move(event) {
    const step = 30;
    const way = {
      ArrowLeft: [-step, 0],
      ArrowRight: [step, 0],
      ArrowUp: [0, -step],
      ArrowDown: [0, step],
    }[event.key];
    if (way) {
      if (event.shiftKey) orbit.shift(...way);
      else orbit.turn(...way);
    } else if (event.key === "+" || event.key === "=") orbit.magnify(1.2);
    else if (event.key === "-") orbit.magnify(1 / 1.2);
    else if (event.key === ",") orbit.roll(-0.1);
    else if (event.key === ".") orbit.roll(0.1);
    else if (event.key === "0" || event.key === "Home") orbit.reset();
    else return false;
    return true;
  }
}

function at(event) {
  return { x: event.clientX, y: event.clientY };
}
