// @ts-check
/** Passkeys: a form that logs in with one, and a form that adds one. The browser asks the device. */

import { say } from "./page.js";

const CANCELLED = "No passkey was used: the device or somebody cancelled, or it took too long.";
const KNOWN = "This device has a passkey of yours already.";
const GONE = "The service cannot be reached. Nothing was sent.";

/** A place of the page, and whether this browser can use passkeys of its service.
 * @param {HTMLElement} element */
function canUsePasskeys(element) {
  const isAble = window.isSecureContext && typeof window.PublicKeyCredential?.parseRequestOptionsFromJSON === "function";
  return isAble && element.dataset.passkeyOrigin === location.origin;
}

/** Ask the service what to ask a device with.
 * @param {string} path
 * @param {RequestInit} [request] */
async function optionsOf(path, request) {
  const answer = await fetch(path, request);
  const found = await answer.json();
  if (!answer.ok) throw new Error(found.detail ?? answer.statusText);
  return found.options;
}

/** @param {unknown} error */
function wordsOf(error) {
  if (error instanceof TypeError) return GONE;
  if (!(error instanceof Error)) return String(error);
  if (error.name === "InvalidStateError") return KNOWN;
  return error.name === "NotAllowedError" || error.name === "AbortError" ? CANCELLED : error.message;
}

/** Have a field filled in by a device, and its form sent.
 * @param {HTMLFormElement} form
 * @param {HTMLButtonElement} button
 * @param {HTMLInputElement} field
 * @param {() => Promise<Credential | null>} ask */
async function send(form, button, field, ask) {
  if (button.disabled || !form.reportValidity()) return;
  button.disabled = true;
  try {
    const credential = /** @type {PublicKeyCredential} */ (await ask());
    field.value = JSON.stringify(credential.toJSON());
    form.submit();
  } catch (error) {
    say(wordsOf(error));
  } finally {
    button.disabled = false;
  }
}

for (const place of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-passkey-origin]"))) {
  if (!canUsePasskeys(place)) continue;
  const button = /** @type {HTMLButtonElement} */ (place.querySelector("[data-passkey]"));
  const form = /** @type {HTMLFormElement} */ (button.form);
  const value = (/** @type {string} */ name) => String(new FormData(form).get(name));
  const field = (/** @type {string} */ name) => /** @type {HTMLInputElement} */ (form.elements.namedItem(name));
  for (const words of /** @type {NodeListOf<HTMLElement>} */ (place.querySelectorAll("[data-passkey-not-here]"))) words.hidden = true;
  button.hidden = false;
  button.addEventListener("click", (event) => {
    event.preventDefault();
    if (button.dataset.passkey === "log-in") {
      send(form, button, field("passkey"), async () => {
        const options = await optionsOf(`/api/v1/login/passkey?name=${encodeURIComponent(value("name"))}`);
        return navigator.credentials.get({ publicKey: PublicKeyCredential.parseRequestOptionsFromJSON(options) });
      });
    } else {
      send(form, button, field("answer"), async () => {
        const body = JSON.stringify({ password: value("password") });
        const headers = { "Content-Type": "application/json" };
        const options = await optionsOf("/api/v1/account/passkeys/options", { method: "POST", headers, body });
        return navigator.credentials.create({ publicKey: PublicKeyCredential.parseCreationOptionsFromJSON(options) });
      });
    }
  });
}
