// The drawing in the page. usvg has written the server's elements, but the page still accepts only those of a list.

import type { Picture } from "./types";

const SVG = "http://www.w3.org/2000/svg";
const XLINK = "http://www.w3.org/1999/xlink";

/** The elements that usvg writes. */
const ELEMENTS = new Set(
  ("svg g path image defs linearGradient radialGradient stop pattern clipPath mask filter feBlend feColorMatrix feComponentTransfer " +
    "feComposite feConvolveMatrix feDiffuseLighting feDisplacementMap feDistantLight feDropShadow feFlood feFuncA feFuncB feFuncG " +
    "feFuncR feGaussianBlur feImage feMerge feMergeNode feMorphology feOffset fePointLight feSpecularLighting feSpotLight feTile " +
    "feTurbulence use").split(" "),
);

/** Links into the drawing, or to an embedded picture. */
const LINK = /^(#|data:image\/(png|jpeg|gif|webp|svg\+xml);base64,)/;

/** Paints and effects from elsewhere. */
const LOADS = /url\(\s*["']?(?!#)/i;

/** Copies the permitted parts of an element. */
function copy(from: Element, lines: (Element | null)[] | null): Element | null {
  if (from.namespaceURI !== SVG || !ELEMENTS.has(from.localName)) {
    skip(from, lines);
    return null;
  }
  const to = document.createElementNS(SVG, from.localName);
  for (const { name, value } of Array.from(from.attributes)) set(to, name, value);
  lines?.push(to);
  for (const child of Array.from(from.children)) {
    const copied = copy(child, lines);
    if (copied) to.append(copied);
  }
  // Account for the line of the closing tag.
  if (from.children.length > 0) lines?.push(null);
  return to;
}

/** Counts the lines of an omitted element. */
function skip(element: Element, lines: (Element | null)[] | null): void {
  lines?.push(null);
  for (const child of Array.from(element.children)) skip(child, lines);
  if (element.children.length > 0) lines?.push(null);
}

/** Sets an attribute of the drawing. */
function set(element: Element, name: string, value: string): void {
  if (name.startsWith("on") || name.startsWith("xmlns")) return;
  if (name === "href" || name === "xlink:href") {
    if (LINK.test(value)) element.setAttributeNS(name === "href" ? null : XLINK, name, value);
    return;
  }
  if (name === "style") {
    // The page's policy forbids style attributes, but permits setting properties.
    for (const [property, ...rest] of value.split(";").map((part) => part.split(":"))) {
      if (property && !LOADS.test(rest.join(":"))) (element as SVGElement).style.setProperty(property.trim(), rest.join(":").trim());
    }
    return;
  }
  if (LOADS.test(value)) return;
  element.setAttribute(name, value);
}

/** Parses a drawing into elements that are safe to show. */
function parse(text: string, lines: (Element | null)[] | null = null): Element | null {
  const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  return copy(root, lines);
}

/** Parses a drawing that is shown beside the picture; its ids get another prefix. */
export function parseWithPrefix(text: string | undefined, prefix: string): Element | null {
  const root = text ? parse(text) : null;
  for (const element of Array.from(root?.querySelectorAll("*") ?? [])) {
    for (const { name, value } of Array.from(element.attributes)) {
      if (name === "id") element.setAttribute(name, `${prefix}-${value}`);
      else if (value.includes("url(#")) element.setAttribute(name, value.replaceAll("url(#", `url(#${prefix}-`));
      else if (name.endsWith("href") && value.startsWith("#")) element.setAttribute(name, `#${prefix}-${value.slice(1)}`);
    }
  }
  return root;
}

/** The drawing on the canvas. */
export class Drawing {
  /** The element that each line of the server's text opens. */
  private lines: (Element | null)[] = [];

  constructor(private layer: SVGGElement) {}

  /** Shows a picture. */
  show(picture: Picture): void {
    if ("changes" in picture) {
      for (const [line, name, value] of picture.changes) {
        const element = this.lines[line];
        if (element) set(element, name, value);
      }
      return;
    }
    this.lines = [];
    const root = parse(picture.whole, this.lines);
    this.layer.replaceChildren(...(root ? Array.from(root.children) : []));
  }

  /** The paths of the drawing, for nodes and handles. */
  paths(): SVGPathElement[] {
    return Array.from(this.layer.querySelectorAll<SVGPathElement>("path")).filter((p) => !p.closest("defs"));
  }
}
