// The tools to measure and to keep pictures: views, cut, probe, ruler, scale, a session beside, pictures and videos.
import type { Frame } from '../bricks/frame';
import type { ColorChoice } from '../color/color_choice';
import type { DecodePool } from '../decode/decode_pool';
import type { RecordingName } from '../recordings/recording_name';
import type { Server } from '../rpc/server';
import { Picture } from '../save/picture';
import { askForFacts, noFacts, type SceneFacts } from '../scene_facts';
import type { Screen } from '../screen';
import type { WatchState } from '../stream/watch_state';
import { download } from '../ui/download';
import type { PageState } from '../ui/link';
import { element } from '../ui/page';
import { coveredMargins, keepPanelsAboveControls, scrollToPanel } from '../ui/panels';
import type { Playback } from '../ui/playback';
import { decimalsOf, lengthText } from '../ui/texts';
import type { ToolsState } from '../ui/tools_link';
import type { Marks } from '../view/annotations';
import { unionOf } from '../view/bounds';
import type { Theme } from '../view/environment';
import { isAxis, type Axis, type UpAxis } from '../view/up_axis';
import type { Viewer } from '../view/viewer';
import { BesideTool } from './beside_tool';
import { ColorTool } from './color_tool';
import { CutTool } from './cut_tool';
import { Pane } from './pane';
import { followPointer, type Spot } from './pointer';
import { Probe } from './probe';
import type { Recorded } from './recording_video';
import { RulerTool } from './ruler_tool';
import { VideoTool } from './video_tool';

export interface ToolsEvents {
  /** The state that the link has. */
  changed(): void;
  /** The camera, in the second picture. */
  moving(moving: boolean): void;
  failed(reason: string): void;
  /** The attribute that the vertices are to carry, or none. */
  attribute(name: string | undefined): void;
  /** There is no such attribute: the panel says so, too. */
  absent(reason: string): void;
  /** All frames of what is looked at, each once, where it is a recording or a publication. */
  allFrames(): ((signal: AbortSignal) => AsyncIterable<Frame>) | undefined;
}

type ToolAction =
  `view-${Axis}` | 'beside' | 'color' | 'cut' | 'probe' | 'ruler' | 'scale' | 'domain' | 'picture' | 'video';

export class Tools {
  /** Each is a button's, of that id. */
  readonly actions: Readonly<Record<ToolAction, () => void>> = {
    'view-x': () => {
      this.lookAlong('x');
    },
    'view-y': () => {
      this.lookAlong('y');
    },
    'view-z': () => {
      this.lookAlong('z');
    },
    beside: () => {
      this.beside.toggle();
    },
    color: () => {
      this.color.toggle();
    },
    cut: () => {
      this.cut.toggle();
    },
    probe: () => {
      this.probe.setActive(!this.probe.active);
      this.redraw();
    },
    ruler: () => {
      this.ruler.setActive(!this.ruler.active);
      this.measured();
      this.events.changed();
    },
    scale: () => {
      this.setScale(!this.scale);
      this.events.changed();
    },
    domain: () => {
      this.setDomain(!this.domain);
      this.events.changed();
    },
    picture: () => void this.savePicture(),
    video: () => {
      this.video.toggle(this.panes, this.recorded());
    },
  };
  private readonly main: Pane;
  private readonly cut: CutTool;
  private readonly probe = new Probe();
  private readonly ruler = new RulerTool();
  private readonly beside: BesideTool;
  private readonly color: ColorTool;
  private readonly video: VideoTool;
  private readonly upSelect = element('up', HTMLSelectElement);
  private at: { readonly session?: string; readonly recording?: RecordingName } = {};
  private facts: SceneFacts | undefined;
  /** By a person, or a link. */
  private chosenUp: UpAxis | undefined;
  private scale = true;
  private domain = true;
  private frame: Frame | undefined;
  /** Where the pointer was last. */
  private pointer: { readonly pane: Pane; readonly spot: Spot } | undefined;
  private pointing = false;
  /** A person moves the camera in the second picture. */
  private besideMoves = false;

  constructor(
    private readonly server: Server,
    private readonly screen: Screen,
    private readonly playback: Playback,
    pool: DecodePool,
    private readonly viewer: Viewer,
    private readonly events: ToolsEvents,
  ) {
    const water = element('view', HTMLCanvasElement);
    this.main = new Pane(water, element('annotations', HTMLCanvasElement), viewer, () => coveredMargins(water));
    this.cut = new CutTool({
      changed: (cut) => {
        this.viewer.setCut(cut);
        this.events.changed();
      },
      box: () => unionOf([this.viewer.box, this.facts?.domain]),
      camera: () => this.viewer.cameraPlace.position,
    });
    this.beside = new BesideTool(server, pool, viewer, {
      changed: () => {
        this.events.changed();
      },
      shown: () => {
        this.color.refresh();
      },
      rendered: (pane) => {
        if (this.besideMoves) this.viewer.mirrorCamera(pane.viewer);
        this.annotate(pane);
      },
      moving: (moving) => {
        if (this.beside.pane) this.viewer.mirrorCamera(this.beside.pane.viewer);
        this.besideMoves = moving;
        this.events.moving(moving);
      },
    });
    this.color = new ColorTool({
      changed: () => {
        if (this.probe.active) this.pointAgain();
        this.events.changed();
      },
      absent: (reason) => {
        this.events.absent(reason);
      },
      attribute: (name) => {
        this.screen.setAttribute(name);
        this.beside.setAttribute(name);
        this.events.attribute(name);
      },
      panes: () => [
        { viewer: this.viewer, shown: this.screen.shown },
        ...(this.beside.pane ? [{ viewer: this.beside.pane.viewer, shown: this.beside.shown }] : []),
      ],
    });
    this.video = new VideoTool((reason) => {
      this.events.failed(reason);
    });
    for (const [id, action] of Object.entries(this.actions))
      element(id, HTMLButtonElement).addEventListener('click', () => {
        action();
        scrollToPanel(id);
      });
    this.upSelect.addEventListener('change', () => {
      if (!isAxis(this.upSelect.value)) return;
      this.chooseUp(this.upSelect.value);
      this.viewer.fit();
      this.events.changed();
    });
    element('probe-middle', HTMLButtonElement).addEventListener('click', () => {
      this.pointAt(this.main, this.viewer.middle);
    });
    element('ruler-middle', HTMLButtonElement).addEventListener('click', () => {
      this.measureAt(this.main, this.viewer.middle);
    });
    this.follow(water, () => this.main);
    this.follow(element('view-beside', HTMLCanvasElement), () => this.beside.pane);
    keepPanelsAboveControls(() => {
      this.viewer.resize();
    });
  }

  /** The scene's up axis: a person's choice, or else the session's. */
  get up(): UpAxis {
    return this.chosenUp ?? this.facts?.up ?? 'y';
  }

  /** None: what the session says. */
  chooseUp(up: UpAxis | undefined): void {
    this.chosenUp = up;
    this.applyUp();
  }

  /** None: water. */
  chooseColor(choice: ColorChoice | undefined): void {
    this.color.set(choice);
  }

  /** For the link. */
  get state(): ToolsState & { readonly up?: UpAxis } {
    return {
      ...(this.chosenUp ? { up: this.chosenUp } : {}),
      ...(this.cut.cut ? { cut: this.cut.cut } : {}),
      ...(this.ruler.both ? { ruler: this.ruler.both } : {}),
      ...(this.beside.session === undefined ? {} : { beside: this.beside.session }),
      ...(this.scale ? {} : { scale: 'off' }),
      ...(this.domain ? {} : { domain: 'off' }),
      ...(this.color.choice ? { color: this.color.choice } : {}),
    };
  }

  /** Something else is looked at, or the list. */
  open(state: PageState): void {
    this.video.stop();
    this.at = state;
    this.facts = undefined;
    this.frame = undefined;
    this.pointer = undefined;
    this.chosenUp = state.up;
    this.applyFacts();
    this.setScale(state.scale !== 'off');
    this.setDomain(state.domain !== 'off');
    this.cut.set(state.cut);
    this.probe.setActive(false);
    this.ruler.setActive(state.ruler !== undefined, state.ruler);
    this.beside.open(state.session, state.beside);
    this.color.open(state.color);
    void this.learn();
  }

  /** A frame has taken the place of the one before; it is drawn next. */
  frameShown(): void {
    this.color.refresh();
    if (this.probe.active) this.pointAgain();
  }

  /** The frame's first picture has been drawn. */
  frameDrawn(frame: Frame): void {
    const first = this.frame === undefined;
    this.frame = frame;
    if (first) this.measured();
    this.cut.show();
  }

  watchState(state: WatchState): void {
    if (state.kind === 'live' && !this.facts) void this.learn();
    this.beside.setPaused(state.kind === 'paused');
  }

  /** The known facts about the source in view. */
  describe(facts: SceneFacts): void {
    this.facts = facts;
    this.applyFacts();
  }

  /** With another token. */
  restart(): void {
    this.beside.restart();
    void this.learn();
  }

  setTheme(theme: Theme): void {
    this.viewer.setTheme(theme);
    this.beside.setTheme(theme);
  }

  /** A picture has been drawn. */
  rendered(): void {
    this.annotate(this.main);
    // A camera that a person moves must not be moved back meanwhile.
    if (!this.besideMoves) this.beside.follow();
  }

  private get panes(): Pane[] {
    return this.beside.pane ? [this.main, this.beside.pane] : [this.main];
  }

  private get unit(): string {
    return this.facts?.unit ?? '';
  }

  /** The digits of lengths: a hundredth of the finest cell's edge. */
  private get decimals(): number {
    return decimalsOf(this.frame?.cellSize ?? 1);
  }

  private get marks(): Omit<Marks, 'legend'> {
    return {
      scale: this.scale,
      probe: this.probe.place,
      ruler: this.ruler.points,
      scaleText: (length) => lengthText(length, this.unit),
      rulerText: this.ruler.text(this.unit, this.decimals),
    };
  }

  private annotate(pane: Pane): void {
    pane.annotate({ ...this.marks, legend: this.color.legend(pane.viewer) });
    this.video.take(pane);
  }

  /** The annotations have changed, and nothing else. */
  private redraw(): void {
    for (const pane of this.panes) pane.viewer.draw();
  }

  /** Asks the server what it knows of what is looked at. */
  private async learn(): Promise<void> {
    const { at } = this;
    const facts = await askForFacts(this.server, at);
    if (at !== this.at || !facts) return;
    this.facts = facts;
    this.applyFacts();
  }

  private applyFacts(): void {
    const { unit, domain } = this.facts ?? noFacts;
    this.applyUp();
    this.cut.setUnit(unit);
    element('domain', HTMLButtonElement).hidden = !domain;
    this.setDomain(this.domain);
    this.measured();
  }

  private applyUp(): void {
    this.upSelect.value = this.up;
    this.viewer.setUp(this.up);
  }

  private setScale(on: boolean): void {
    this.scale = on;
    element('scale', HTMLButtonElement).setAttribute('aria-pressed', String(on));
    this.redraw();
  }

  private setDomain(on: boolean): void {
    this.domain = on;
    element('domain', HTMLButtonElement).setAttribute('aria-pressed', String(on));
    this.viewer.setDomain(on ? this.facts?.domain : undefined);
  }

  private lookAlong(axis: Axis): void {
    this.viewer.lookAlong(axis);
    this.events.changed();
  }

  private follow(canvas: HTMLCanvasElement, pane: () => Pane | undefined): void {
    followPointer(canvas, {
      over: (spot) => {
        const over = pane();
        if (over && this.probe.active) this.pointAt(over, spot);
      },
      tapped: (spot) => {
        const over = pane();
        if (over && this.probe.active) this.pointAt(over, spot);
        if (over && this.ruler.active) this.measureAt(over, spot);
      },
    });
  }

  private pointAt(pane: Pane, spot: Spot): void {
    this.pointer = { pane, spot };
    this.pointAgain();
  }

  /** Once for each picture, however fast the pointer is. */
  private pointAgain(): void {
    if (this.pointing) return;
    this.pointing = true;
    requestAnimationFrame(() => {
      this.pointing = false;
      if (!this.pointer || !this.probe.active) return;
      const { pane, spot } = this.pointer;
      const picked = pane.viewer.pick(...spot);
      this.probe.show(picked, this.unit, this.decimals, this.color.valueAt(pane.viewer, picked?.spot));
      this.redraw();
    });
  }

  private measureAt(pane: Pane, spot: Spot): void {
    const picked = pane.viewer.pick(...spot);
    if (!picked) return;
    this.ruler.add(picked.place);
    this.measured();
    this.events.changed();
  }

  private measured(): void {
    this.ruler.show(this.unit, this.decimals);
    this.redraw();
  }

  private async savePicture(): Promise<void> {
    if (!this.frame) return;
    const picture = new Picture(this.panes);
    picture.takeAll();
    const name = `meniscus-${this.frame.index}.png`;
    try {
      download(name, 'image/png', await picture.png());
    } catch (error) {
      this.events.failed(error instanceof Error ? error.message : String(error));
    }
  }

  private recorded(): Recorded | undefined {
    const { at } = this;
    const frames = this.events.allFrames();
    if (!frames) return undefined;
    this.playback.setPaused(true);
    return {
      length: this.playback.length,
      frames,
      draw: (frame) => this.screen.draw(frame),
      done: () => {
        // Back to the frame of the slider.
        if (at === this.at) this.playback.step(0);
      },
    };
  }
}
