// One colour a meaning, after Okabe and Ito: told apart with any kind of colour vision, and the same
// as in the report's pictures (ReportPalette).
export const palette = {
  initial: "#525c6a",
  adapted: "#0064b0",
  dropped: "#d55e00",
  pinned: "#00825f",
  conflicts: "#a8428c",
  field: "#6b4fa0",
  fewerQuads: "#c81e3c",
  moreQuads: "#283cc8",
  highlight: "#ffd21f",
  surface: "#e6eaef",
};

// Classes of a triangle's smallest angle, degrees: below `under` and not below the one before.
export const angleClasses = [
  { under: 15, color: "#b33c00", name: "under 15°" },
  { under: 30, color: "#f2a541", name: "15° to 30°" },
  { under: 45, color: "#a9cdea", name: "30° to 45°" },
  { under: 61, color: "#4a90c8", name: "45° and more" },
];

// Classes of a quad's scaled Jacobian, as above.
export const jacobianClasses = [
  { under: 0.3, color: "#b33c00", name: "under 0.3" },
  { under: 0.6, color: "#f2a541", name: "0.3 to 0.6" },
  { under: 0.85, color: "#a9cdea", name: "0.6 to 0.85" },
  { under: 1.1, color: "#4a90c8", name: "0.85 and more" },
];

// Of a vertex at which other than four quads meet.
export function singularColor(valence) {
  return valence < 4 ? palette.fewerQuads : palette.moreQuads;
}

export function rgb(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}
