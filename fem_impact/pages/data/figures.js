
// Draws the figures of the page with Plotly, which the page holds compressed.
const unpack = async (text) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
};
const touch = matchMedia("(pointer: coarse)").matches; // a finger on a figure shall scroll the page
const settings = { responsive: true, displaylogo: false, displayModeBar: touch ? false : "hover" };
const draw = (figure) => {
  if (figure.dataset.drawn || !figure.offsetParent) return; // once, and not while it is folded
  figure.dataset.drawn = "yes";
  const panels = JSON.parse(figure.querySelector("script").textContent);
  figure.querySelectorAll(".plot").forEach((place, at) => {
    const layout = { ...panels[at].layout, dragmode: touch ? false : "zoom" };
    const eye = place.clientWidth < 600 && layout.scene?.camera.eye;
    if (eye) for (const axis in eye) eye[axis] *= 1.5; // the whole rod on a phone
    Plotly.newPlot(place, { ...panels[at], layout, config: settings });
  });
};
const drawAll = () => document.querySelectorAll("figure.live").forEach(draw);
unpack(document.getElementById("library").textContent).then((text) => {
  const script = document.createElement("script");
  script.textContent = text;
  document.head.append(script);
  drawAll();
  document.addEventListener("toggle", drawAll, true);
  document.documentElement.dataset.figures = "drawn";
});
