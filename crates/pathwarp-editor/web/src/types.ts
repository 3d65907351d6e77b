// The messages of the server, and geometry.

export type XY = [number, number];

export interface Step {
  deformation: string;
  inverse: boolean;
  args: Record<string, string[]>;
  /** Selectors of the parts of the drawing that it holds for, and of what it leaves out. */
  select?: string[];
  exclude?: string[];
  /** The user's name for it, in the draft alone. */
  name?: string;
  /** It bends nothing for the time being, and is in no result. */
  hidden?: boolean;
}

/** A group or shape of the drawing. */
export interface Part {
  name: string;
  /** What names it in a step. */
  selector: string;
  label: string | null;
  element: string;
  depth: number;
}

export type Kind =
  | "flag" | "number" | "numbers" | "length" | "angle" | "count" | "point" | "path" | "choice" | "text" | "name" | "file";

export interface Param {
  name: string;
  /** A name for people, if the registry's own is not one. */
  label?: string;
  kind: Kind;
  needed: boolean;
  repeat: boolean;
  help: string;
  slider: [number, number];
  words?: string[];
  notation?: string;
  /** Parameters that cannot go with this one, and a value of another that does. */
  instead?: { others: string[]; with: [string, string] | null };
  axis?: "x" | "y" | "diagonal";
  /** Paths that may have any number of points, or rows with equally many. */
  points?: "any" | "rows";
  default?: string;
  least?: number;
  most?: number;
}

export interface Deformation {
  name: string;
  /** A name for people, if the registry's own is not one. */
  label: string | null;
  title: string;
  group: string;
  about: string;
  /** It changes the drawing before it is bent, so it comes before all that bends. */
  first: boolean;
  /** Its names in other programs. */
  knownAs: string[];
  params: Param[];
  /** Other ways to begin, each by one parameter. */
  variants: { label: string; param: string }[];
  gallery: { title: string; presets: string; bend: string | null; axis: string | null } | null;
}

export interface Subpath {
  start: XY;
  segments: number[][];
  closed: boolean;
}

/** Control points with their indices as typed, and the lines that join them. */
export interface Net {
  names: string[];
  points: XY[];
  lines: number[][];
}

export interface Stretch {
  columns: number;
  points: (XY | null)[];
  factors: (number | null)[];
}

/** An adjust value of a text shape, in 1/100000 of the box or, if it goes beyond a million, 1/60000 of a degree. */
export interface Adjust {
  name: string;
  least: number;
  most: number;
  default: number;
  value?: number;
}

export interface Grip {
  adjust?: Adjust[];
  point?: XY;
  points?: XY[];
  pairs?: [XY, XY][];
  net?: Net;
  paths?: Subpath[][];
  /** Centre, radius, and the angles in degrees at which a circle or an arc begins and ends. */
  circle?: [number, number, number, number, number];
  value?: number;
  /** A surface as typed, with its lengths in units of the drawing. */
  surface?: { text: string; sizes: [string, number][] };
}

export interface StepGrips {
  frame: [number, number, number, number];
  params: Record<string, Grip>;
}

export interface State {
  file: string;
  folder: string;
  /** A name for what is on show; the same drawing in other words has another. */
  drawing: string;
  steps: Step[];
  undo: boolean;
  redo: boolean;
  saved: boolean;
  savedTo: string | null;
  /** The folder that the result was saved in last, unless that of the drawing. */
  savedIn: string | null;
  target: string;
  /** The command that goes on with the steps. */
  again: string;
  /** The program that waits for the steps, if one does. */
  program: string | null;
  restored: boolean;
  problem: string | null;
  toPx: [number, number, number, number, number, number];
  page: [number, number, number, number];
  missing: string[];
  /** The words that the drawing was set from, if it was. */
  words: Words | null;
  /** The drawing is a photograph alone, a px for each of its pixels. */
  photograph: boolean;
}

/** Words, their family, the size in mm, and the space between letters in per cent of it. */
export interface Words {
  text: string;
  font: string | null;
  size: number;
  spacing: number;
}

export interface Summary {
  segmentsIn: number;
  segmentsOut: number;
  error: number;
  tolerance: number;
  folds: [string, XY][];
}

export type Picture = { whole: string } | { changes: [number, string, string][] };

export interface Answer {
  id?: number;
  error?: string;
  picture?: Picture;
  grips?: StepGrips[];
  /** The places of steps for parts that the drawing lacks. */
  gone?: number[];
  guides?: string[];
  warnings?: string[];
  /** Characters that no font has. */
  lacking?: string[];
  /** The page that saving gives the result, if that is not the drawing's. */
  page?: [number, number, number, number] | null;
  summary?: Summary;
  state?: State;
  catalogue?: Deformation[];
  svg?: string;
  step?: Step;
  /** How far a net with other points bends from where it did, in user units. */
  moved?: number;
  at?: XY | null;
  text?: string;
  /** The background as it was kept, with its content as base64. */
  background?: { name: string; type: string; bytes: string; lie: { x: number; y: number; width: number; turn: number }; opacity: string } | null;
  written?: string;
  exists?: string;
  /** The reason why nothing could be written. */
  unwritable?: string;
  /** A file, as base64. */
  bytes?: string;
  copied?: boolean;
  presets?: string[];
  parts?: Part[];
  families?: string[];
  steps?: Step[];
  stretch?: Stretch | null;
  event?: string;
  done?: boolean;
}

export type Shape = "node" | "control" | "source";

export interface Handle {
  /** The same for the same handle of another picture. */
  key: string;
  param: string;
  shape: Shape;
  label: string;
  /** The row or path it belongs to: symmetry looks for partners there. */
  group: string;
  get: () => XY;
  /** Moves it, and what is tied to it. */
  set: (to: XY, smooth: boolean) => void;
  /** Takes it away; only handles of which there may be any number can. */
  remove?: () => void;
}

export interface Line {
  kind: "path" | "arm" | "net";
  points: XY[];
  /** Control points of cubics, as in path data. */
  cubic?: boolean;
  closed?: boolean;
}
