// The page: the list of sessions and recordings, or one of them.
import { startDecodePool } from './decode/decode_pool';
import type { Frame } from './bricks/frame';
import { RecordingView } from './recordings/recording_view';
import { recordingNameText } from './recordings/recording_name';
import { Server } from './rpc/server';
import { writeGlb } from './save/glb';
import { writePly } from './save/ply';
import { Screen } from './screen';
import { SessionView } from './session_view';
import type { WatchState } from './stream/watch_state';
import { Banner } from './ui/banner';
import { download } from './ui/download';
import { readLink, writeLink, type PageState } from './ui/link';
import { Overlay } from './ui/overlay';
import { element } from './ui/page';
import { coveredMargins } from './ui/panels';
import { Playback } from './ui/playback';
import { RecordingList } from './ui/recording_list';
import { SessionList } from './ui/session_list';
import { followTheme } from './ui/theme';
import { Tools } from './tools/tools';
import { askToken, storedToken } from './ui/token_dialog';
import { Viewer, type Look } from './view/viewer';

export class App {
  private readonly server = new Server({ base: '', fetch: (input, init) => fetch(input, init) });
  private readonly banner = new Banner();
  private readonly canvas = element('view', HTMLCanvasElement);
  private readonly viewer: Viewer;
  private readonly screen: Screen;
  private readonly playback = new Playback();
  private readonly tools: Tools;
  private readonly sessionView: SessionView;
  private readonly recordingView: RecordingView;
  private readonly list: SessionList;
  private readonly recordings: RecordingList;
  /** What is looked at. */
  private at: Pick<PageState, 'session' | 'recording' | 'position'> = {};
  private look: Look = 'water';
  private particles = false;
  /** From the link, for the first picture. */
  private linked: PageState = {};

  constructor() {
    this.server.token = storedToken();
    this.viewer = new Viewer(this.canvas, () => coveredMargins(this.canvas), {
      rendered: () => {
        this.tools.rendered();
      },
      drawn: (frame, triangles, particles) => {
        // For those who look from outside: tests, and assistive tools.
        this.canvas.dataset.frame = String(frame.index);
        this.canvas.dataset.triangles = String(triangles);
        if (particles) this.canvas.dataset.particles = String(particles.index);
        else delete this.canvas.dataset.particles;
        this.screen.overlay.particlesDrawn(frame, particles);
        this.frameDrawn(frame);
      },
      moving: (moving) => {
        this.cameraMoving(moving);
      },
      lost: (lost) => {
        this.inPlaceOfPicture(
          lost
            ? 'The browser has taken the graphics away. The picture returns when it gives them back; loading the page again may help.'
            : '',
        );
      },
    });
    const pool = startDecodePool();
    this.screen = new Screen(pool, this.viewer, new Overlay(), {
      shown: () => {
        this.sessionView.showParticles();
      },
      failed: (reason) => {
        this.banner.say(reason);
      },
      recovered: () => {
        this.banner.say('');
      },
      firstFrame: () => {
        this.firstFrame();
      },
    });
    this.tools = new Tools(this.server, this.screen, this.playback, pool, this.viewer, {
      changed: () => {
        this.writeAddress();
      },
      moving: (moving) => {
        this.cameraMoving(moving);
      },
      failed: (reason) => {
        this.banner.say(reason);
      },
    });
    this.sessionView = new SessionView(this.server, this.screen, this.playback, {
      state: (state) => {
        this.watchState(state);
      },
      failed: (reason) => {
        this.banner.say(reason);
      },
      recovered: () => {
        this.banner.say('');
      },
    });
    this.recordingView = new RecordingView(this.server, this.screen, this.playback, {
      state: (state) => {
        this.watchState(state);
      },
      restsAt: (position) => {
        this.at = { ...this.at, position };
        this.writeAddress();
      },
    });
    this.recordings = new RecordingList(this.server, (recording) => {
      this.go({ recording });
    });
    this.list = new SessionList(this.server, this.banner, {
      chosen: (session) => {
        this.go({ session });
      },
      tokenNeeded: (reason) => void this.tokenNeeded(reason),
    });
    followTheme((theme) => {
      this.tools.setTheme(theme);
    });
    this.bindControls();
    addEventListener('popstate', () => {
      this.open(readLink(location.hash));
    });
    this.open(readLink(location.hash));
  }

  private go(state: PageState): void {
    history.pushState(null, '', writeLink(state));
    this.open(state);
    // What was chosen with the keyboard goes on with the keyboard.
    if (!state.session && !state.recording) element('list-heading', HTMLElement).focus();
    else this.canvas.focus();
  }

  private open(state: PageState): void {
    this.linked = state;
    this.at = {
      ...(state.session === undefined ? {} : { session: state.session }),
      ...(state.recording ? { recording: state.recording } : {}),
    };
    this.sessionView.stop();
    this.recordingView.stop();
    this.screen.clear();
    this.playback.play(undefined);
    delete this.canvas.dataset.frame;
    delete this.canvas.dataset.triangles;
    delete this.canvas.dataset.particles;
    this.banner.say('');
    const watching = this.looking;
    element('watch', HTMLElement).hidden = !watching;
    element('leave', HTMLButtonElement).hidden = !watching;
    element('title', HTMLElement).textContent = state.recording
      ? `Recording ${recordingNameText(state.recording)}`
      : (state.session ?? '');
    this.inPlaceOfPicture('');
    this.tools.open(state);
    if (!watching) {
      this.list.show();
      this.recordings.show();
      return;
    }
    this.list.hide();
    this.recordings.hide();
    this.setLook(state.look ?? 'water');
    this.setParticles(false);
    if (state.recording) this.recordingView.start(state.recording, state.position);
    else this.sessionView.start(state.session!);
  }

  /** Whether something is looked at, or else the list. */
  private get looking(): boolean {
    return this.at.session !== undefined || this.at.recording !== undefined;
  }

  private frameDrawn(frame: Frame): void {
    if (!this.screen.frameDrawn(frame)) return;
    this.tools.frameDrawn(frame);
    if (this.at.recording) this.recordingView.frameDrawn(frame);
    else this.sessionView.frameDrawn(frame);
  }

  private firstFrame(): void {
    this.inPlaceOfPicture('');
    if (this.linked.camera) this.viewer.cameraPlace = this.linked.camera;
    else this.viewer.fit();
  }

  private watchState(state: WatchState): void {
    this.canvas.dataset.state = state.kind;
    this.banner.watching(state);
    this.tools.watchState(state);
    if (!this.screen.shown)
      this.inPlaceOfPicture(
        state.kind === 'connecting'
          ? 'Connecting…'
          : state.kind === 'connected'
            ? 'Connected. No frame has come yet.'
            : '',
      );
    if (state.kind === 'token') void this.tokenNeeded(state.reason);
  }

  private cameraMoving(moving: boolean): void {
    this.sessionView.cameraMoving(moving);
    if (!moving) this.writeAddress();
  }

  private inPlaceOfPicture(text: string): void {
    element('in-place-of-picture', HTMLElement).textContent = text;
  }

  private async tokenNeeded(reason: string): Promise<void> {
    this.banner.tokenNeeded(reason);
    const token = await askToken(reason);
    if (token === undefined) return;
    this.server.token = token;
    this.banner.say('');
    if (this.at.recording) this.recordingView.restart();
    else if (this.at.session !== undefined) this.sessionView.restart();
    else this.open({});
    this.tools.restart();
  }

  private bindControls(): void {
    const actions: Record<string, () => void> = {
      leave: () => {
        this.go({});
      },
      look: () => {
        this.setLook(this.look === 'water' ? 'levels' : 'water');
      },
      'show-particles': () => {
        this.setParticles(!this.particles);
      },
      fit: () => {
        this.viewer.fit();
      },
      full: () => void toggleFullScreen().catch(() => undefined),
      'ask-token': () => void this.tokenNeeded(''),
      measure: () => {
        this.toggleOverlay();
      },
      glb: () => {
        this.save('glb', 'model/gltf-binary');
      },
      ply: () => {
        this.save('ply', 'application/octet-stream');
      },
      link: () => void this.copyLink(),
    };
    for (const [id, action] of Object.entries(actions))
      element(id, HTMLButtonElement).addEventListener('click', action);
    element('full', HTMLButtonElement).hidden = !document.fullscreenEnabled;
    const keys: Record<string, () => void> = {
      ' ': () => {
        this.playback.toggle();
      },
      ',': () => {
        this.playback.step(-1);
      },
      '.': () => {
        this.playback.step(1);
      },
      f: () => {
        this.viewer.fit();
      },
      w: () => {
        actions.look!();
      },
      p: () => {
        this.setParticles(!this.particles);
      },
      m: () => {
        this.toggleOverlay();
      },
    };
    this.canvas.addEventListener('keydown', (event) => {
      const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
      if (!action) return;
      event.preventDefault();
      action();
    });
  }

  private setLook(look: Look): void {
    this.look = look;
    this.viewer.setLook(look);
    element('look', HTMLButtonElement).setAttribute('aria-pressed', String(look === 'levels'));
    this.writeAddress();
  }

  /** Recordings are shown without. */
  private setParticles(wanted: boolean): void {
    this.particles = wanted && this.at.session !== undefined;
    this.sessionView.setParticles(this.particles);
    const button = element('show-particles', HTMLButtonElement);
    button.hidden = this.at.session === undefined;
    button.setAttribute('aria-pressed', String(this.particles));
  }

  private toggleOverlay(): void {
    const overlay = element('overlay', HTMLElement);
    overlay.hidden = !overlay.hidden;
    element('measure', HTMLButtonElement).setAttribute('aria-pressed', String(!overlay.hidden));
    this.viewer.resize();
  }

  private save(kind: 'glb' | 'ply', type: string): void {
    const { shown } = this.screen;
    if (!shown) return;
    download(
      `meniscus-${shown.frame.index}.${kind}`,
      type,
      kind === 'glb' ? writeGlb(shown, this.tools.up) : writePly(shown),
    );
  }

  private writeAddress(): void {
    if (!this.screen.shown || !this.looking) return;
    history.replaceState(
      null,
      '',
      writeLink({ ...this.at, ...this.tools.state, camera: this.viewer.cameraPlace, look: this.look }),
    );
  }

  private async copyLink(): Promise<void> {
    this.writeAddress();
    const button = element('link', HTMLButtonElement);
    // There is no clipboard for pages that came without TLS from another machine; the address bar has the same link.
    const clipboard = navigator.clipboard as Clipboard | undefined;
    const copied = await clipboard?.writeText(location.href).then(
      () => true,
      () => false,
    );
    const label = button.querySelector('span')!;
    label.textContent = copied ? 'Copied' : 'See the address bar';
    label.classList.add('kept');
    setTimeout(() => {
      label.textContent = 'Copy link';
      label.classList.remove('kept');
    }, 2000);
  }
}

/** The whole page: what goes wrong is to be read in full screen too. */
async function toggleFullScreen(): Promise<void> {
  if (document.fullscreenElement) await document.exitFullscreen();
  else await document.documentElement.requestFullscreen();
}
