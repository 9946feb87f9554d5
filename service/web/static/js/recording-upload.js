// @ts-check
/** Files of a recording may be dropped onto the form; the browser then sends it as if they had been chosen. */

for (const form of document.querySelectorAll("form[data-upload]")) {
  const place = /** @type {HTMLElement} */ (form.querySelector("[data-drop]"));
  const input = /** @type {HTMLInputElement} */ (form.querySelector("input[type=file]"));
  const said = /** @type {HTMLElement} */ (form.querySelector("[data-drop-said]"));
  const words = /** @type {HTMLElement} */ (form.querySelector("[data-drop-words]"));
  words.hidden = false;
  const tell = () => {
    said.textContent = [...(input.files ?? [])].map((file) => file.name).join(", ");
  };
  input.addEventListener("change", tell);
  for (const kind of ["dragenter", "dragover"]) {
    place.addEventListener(kind, (event) => {
      event.preventDefault();
      place.classList.add("is-over");
    });
  }
  place.addEventListener("dragleave", () => place.classList.remove("is-over"));
  place.addEventListener("drop", (event) => {
    event.preventDefault();
    place.classList.remove("is-over");
    if (!event.dataTransfer || event.dataTransfer.files.length === 0) return;
    input.files = event.dataTransfer.files;
    tell();
  });
}
