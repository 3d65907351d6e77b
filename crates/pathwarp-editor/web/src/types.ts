// The server's messages, and geometry.

export type XY = [number, number];
/** A box as x, y, width and height. */
export type Frame = [number, number, number, number];
/** A circle or arc: its centre's x and y, its radius, and its start and end angles in degrees, clockwise from the right. */
export type Arc = [number, number, number, number, number];

export interface Step {
  deformation: string;
  inverse: boolean;
  args: Record<string, string[]>;
  /** Selectors of the parts of the drawing that it applies to, and of those that it leaves out. */
  select?: string[];
  exclude?: string[];
  /** The user's name for it; only drafts store it. */
  name?: string;
  /** `true` if it is switched off, and in no result. */
  hidden?: boolean;
}

/** A group or shape of the drawing. */
export interface Part {
  name: string;
  /** The selector that names it in a step. */
  selector: string;
  label: string | null;
  element: string;
  depth: number;
}

export type Kind =
  | "flag" | "number" | "numbers" | "length" | "angle" | "count" | "point" | "path" | "choice" | "text" | "name" | "file";

export interface Param {
  name: string;
  /** A name for display, if the registry's is not suitable. */
  label?: string;
  kind: Kind;
  needed: boolean;
  repeat: boolean;
  help: string;
  slider: [number, number];
  words?: string[];
  notation?: string;
  /** Parameters that exclude this one, and a value of another parameter that it requires. */
  instead?: { others: string[]; with: [string, string] | null };
  axis?: "x" | "y" | "diagonal";
  /** Set for paths with any number of points, or rows of equal length. */
  points?: "any" | "rows";
  default?: string;
  least?: number;
  most?: number;
}

export interface Deformation {
  name: string;
  /** A name for display, if the registry's is not suitable. */
  label: string | null;
  title: string;
  group: string;
  about: string;
  /** `true` for an edit, which changes the drawing before it is bent and comes first. */
  first: boolean;
  /** Its names in other programs. */
  knownAs: string[];
  params: Param[];
  /** Alternative starts, each by one parameter. */
  variants: { label: string; param: string }[];
  /** A set of presets: the parameters that choose one, its bend and its axis. */
  gallery: { title: string; presets: string; bend: string | null; axis: string | null } | null;
}

export interface Subpath {
  start: XY;
  /** For each segment the points after its start: x, y of a line's end, or three points of a cubic. */
  segments: number[][];
  closed: boolean;
}

/** Control points, `names` with their indices as typed, and the lines that connect them, lists of indices into `points`. */
export interface Net {
  names: string[];
  points: XY[];
  lines: number[][];
}

/** The images of a grid's points, row by row, and for each cell the factor of lengths, which is negative in folds. */
export interface Stretch {
  columns: number;
  points: (XY | null)[];
  factors: (number | null)[];
}

/** An adjust value of a text shape, in 1/100000 of the box or, beyond a million, in 1/60000 of a degree. */
export interface Adjust {
  name: string;
  least: number;
  most: number;
  default: number;
  value?: number;
}

/** The handles of a parameter; its kind determines which field is set. A pair leads from the artwork to where it goes. */
export interface Grip {
  adjust?: Adjust[];
  point?: XY;
  points?: XY[];
  pairs?: [XY, XY][];
  net?: Net;
  paths?: Subpath[][];
  circle?: Arc;
  value?: number;
  /** A surface as typed, with its lengths in units of the drawing. */
  surface?: { text: string; sizes: [string, number][] };
}

export interface StepGrips {
  frame: Frame;
  params: Record<string, Grip>;
}

export interface State {
  file: string;
  folder: string;
  /** A name for the drawing on show, which depends on its words. */
  drawing: string;
  steps: Step[];
  undo: boolean;
  redo: boolean;
  saved: boolean;
  savedTo: string | null;
  /** The folder of the saved result, if it is not the drawing's. */
  savedIn: string | null;
  target: string; // The file that *Save* writes by default.
  /** The command that continues with the steps. */
  again: string;
  /** The program that waits for the steps, if any. */
  program: string | null;
  restored: boolean; // `true` if the steps are unsaved ones of an earlier session.
  problem: string | null; // The reason why the draft of unsaved steps could not be stored.
  /** The coefficients of the map from user units to px of the drawing, as in SVG's `matrix`. */
  toPx: [number, number, number, number, number, number];
  page: Frame;
  missing: string[]; // Sentences about fonts and images that were not found.
  /** The words that the drawing was set from, if any. */
  words: Words | null;
  /** `true` if the drawing consists of a photograph, with one px for each pixel. */
  photograph: boolean;
}

/** Words, their family, their size in mm, and the space between letters in percent of it. */
export interface Words {
  text: string;
  font: string | null;
  size: number;
  spacing: number;
}

/** `error` and `tolerance` are in user units; folds have the shape's id and a point of the drawing. */
export interface Summary {
  segmentsIn: number;
  segmentsOut: number;
  error: number;
  tolerance: number;
  folds: [string, XY][];
}

/** The SVG, or what differs from the last one: the line of the element, the attribute's name and its value. */
export type Picture = { whole: string } | { changes: [number, string, string][] };

export interface Answer {
  id?: number;
  error?: string;
  picture?: Picture;
  grips?: StepGrips[];
  /** The indices of steps for parts that the drawing lacks. */
  gone?: number[];
  guides?: string[]; // Path data of cages and other lines that no parameter defines.
  warnings?: string[];
  /** Characters that no font has. */
  lacking?: string[];
  /** The page of the saved result, if it is not the drawing's. */
  page?: Frame | null;
  summary?: Summary;
  state?: State;
  catalogue?: Deformation[];
  svg?: string;
  step?: Step;
  /** The largest distance by which a new net moves points, in user units. */
  moved?: number;
  at?: XY | null; // The point that the last step maps to the requested one, if there is one.
  text?: string; // The command line.
  /** The stored background, with its content as base64 and its position in `lie`, a `Placement`. */
  background?: { name: string; type: string; bytes: string; lie: { x: number; y: number; width: number; turn: number }; opacity: string } | null;
  written?: string; // The name of the file written.
  exists?: string; // The name of an existing file that was not replaced.
  /** The reason why nothing could be written. */
  unwritable?: string;
  /** The content of a file as base64. */
  bytes?: string;
  copied?: boolean; // `true` if the file was written beside the drawing; `false` if it was there.
  presets?: string[];
  parts?: Part[];
  families?: string[];
  steps?: Step[];
  stretch?: Stretch | null;
  event?: string; // `changed` in a message that answers nothing: another page has changed the steps.
  done?: boolean; // `true` once the waiting program has the steps.
}

/** `source` is a point in the artwork before the step. */
export type Shape = "node" | "control" | "source";

export interface Handle {
  /** A key that is equal for this handle in other pictures. */
  key: string;
  param: string;
  shape: Shape;
  label: string;
  /** The row or path that it belongs to, in which symmetry looks for partners. */
  group: string;
  get: () => XY;
  /** Moves it, and the points that depend on it; `smooth` keeps smooth nodes smooth. */
  set: (to: XY, smooth: boolean) => void;
  /** Removes it, if there may be any number of its kind. */
  remove?: () => void;
}

export interface Line {
  kind: "path" | "arm" | "net";
  points: XY[];
  /** `true` if the points are control points of cubics, as in path data. */
  cubic?: boolean;
  closed?: boolean;
}
