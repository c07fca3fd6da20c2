// The page: the list of sessions and recordings, or one of them.
import { wantedCodecs } from './bricks/codecs';
import { normalWish } from './bricks/normals_by';
import { startDecodePool } from './decode/decode_pool';
import type { Frame } from './bricks/frame';
import { readEmbedding } from './frame/embedding';
import { listenToPage } from './frame/frame_guest';
import type { HandedOver } from './frame/messages';
import { bindKeys } from './keys/page_keys';
import { ThumbnailPainter } from './list/thumbnail_painter';
import { publicationOf } from './publications/publication_place';
import { PublicationView } from './publications/publication_view';
import { recordedFrames } from './recordings/recorded_frames';
import { RecordingView } from './recordings/recording_view';
import { Server } from './rpc/server';
import { writeGlb } from './save/glb';
import { writePly } from './save/ply';
import { givenName } from './list/session_name';
import { factsOfPublication } from './scene_facts';
import { Screen } from './screen';
import { SessionView } from './session_view';
import type { WatchState } from './stream/watch_state';
import { Banner } from './ui/banner';
import { copyAddress } from './ui/copy_address';
import { download } from './ui/download';
import { toggleFullScreen } from './ui/full_screen';
import { Heading } from './ui/heading';
import { readLink, withoutServer, writeLink, type PageState } from './ui/link';
import { nameOnLongPress } from './ui/long_press';
import { Overlay } from './ui/overlay';
import { element } from './ui/page';
import { coveredMargins } from './ui/panels';
import { Playback } from './ui/playback';
import { RecordingList } from './ui/recording_list';
import { RecordingOffer } from './ui/recording_offer';
import { SessionList } from './ui/session_list';
import { SessionOffer } from './ui/session_offer';
import { followTheme } from './ui/theme';
import { Tools } from './tools/tools';
import { askToken, storedToken } from './ui/token_dialog';
import { Viewer, type Look } from './view/viewer';

export class App {
  private readonly server = new Server(
    { base: '', fetch: (input, init) => fetch(input, init) },
    wantedCodecs(location),
    normalWish(location),
  );
  private readonly banner = new Banner();
  private readonly heading = new Heading(this.server, (live) => {
    this.streaming = live;
    this.showWhatApplies();
  });
  private readonly offer = new RecordingOffer(this.server, (recording) => {
    this.go({ recording });
  });
  private readonly sessionOffer = new SessionOffer(this.server, (session) => {
    this.go(session === undefined ? {} : { session });
  });
  /** Set where the viewer is to show the water alone. */
  private readonly embedding = readEmbedding(location.search);
  private readonly canvas = element('view', HTMLCanvasElement);
  private readonly viewer: Viewer;
  private readonly screen: Screen;
  private readonly playback = new Playback(() => {
    this.writeAddress();
  });
  private readonly tools: Tools;
  private readonly sessionView: SessionView;
  private readonly recordingView: RecordingView;
  private readonly publicationView: PublicationView;
  /** That which this page shows, whatever else its address says. */
  private readonly publication = publicationOf(document, location, () => this.server.token);
  private readonly list: SessionList;
  private readonly recordings: RecordingList;
  /** The session, or the recording and the place in it, that is shown. */
  private at: Pick<PageState, 'session' | 'recording' | 'position'> = {};
  private look: Look = 'water';
  private particles = false;
  /** Whether the session that is shown is being streamed. */
  private streaming = false;
  private watchKind: WatchState['kind'] = 'connecting';
  /** From the link, for the first picture. */
  private linked: PageState = {};
  /** Whether nothing is tried any more. */
  private watchIsOver = false;
  /** Why a token is needed. */
  private tokenReason = '';
  /** Whether the last state that the page around handed over cannot be. */
  private handingFailed = false;

  constructor() {
    // In a frame there is none but the one that the page around hands over, and none stays.
    if (this.embedding) this.embed(this.embedding.page);
    else this.server.token = storedToken();
    const pool = startDecodePool();
    const painter = new ThumbnailPainter(pool);
    this.viewer = new Viewer(this.canvas, () => coveredMargins(this.canvas), {
      rendered: () => {
        this.tools.rendered();
      },
      drawn: (frame, triangles, particles) => {
        // For readers outside of the page: tests, and assistive tools.
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
    this.screen = new Screen(pool, this.viewer, new Overlay(), {
      shown: () => {
        this.tools.frameShown();
        this.sessionView.showParticles();
      },
      failed: (reason) => {
        this.banner.say(reason);
      },
      recovered: () => {
        this.banner.say('');
      },
      firstShown: () => {
        this.place(this.linked.camera);
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
      attribute: (name) => {
        this.sessionView.setAttribute(name);
      },
      absent: (reason) => {
        // A viewer that shows the water alone has no panel to say it.
        if (!this.embedding) return;
        this.handingFailed = true;
        this.banner.say(reason);
      },
      allFrames: () => this.allFrames(),
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
      found: (recording) => {
        this.heading.described(recording);
      },
      restsAt: (position) => {
        this.restsAt(position);
      },
    });
    this.publicationView = new PublicationView(this.screen, this.playback, {
      state: (state) => {
        this.watchState(state);
      },
      found: (manifest) => {
        this.heading.showPublication(givenName(manifest));
        this.tools.describe(factsOfPublication(manifest));
      },
      restsAt: (position) => {
        this.restsAt(position);
      },
    });
    this.recordings = new RecordingList(this.server, painter, (recording) => {
      this.go({ recording });
    });
    this.list = new SessionList(this.server, painter, this.banner, {
      chosen: (session) => {
        this.go({ session });
      },
      tokenNeeded: (reason) => void this.tokenNeeded(reason),
    });
    followTheme((theme) => {
      this.tools.setTheme(theme);
      painter.setTheme(theme);
      this.list.themeChanged();
      this.recordings.themeChanged();
    });
    this.bindControls();
    // There they take half of the picture.
    if (matchMedia('(max-width: 640px)').matches) this.showFigures(false);
    nameOnLongPress(element('toolbar', HTMLElement), element('hint', HTMLElement));
    addEventListener('popstate', () => {
      this.open(readLink(location.hash));
    });
    this.open(readLink(location.hash));
  }

  private go(state: PageState): void {
    history.pushState(null, '', writeLink(state));
    this.open(state);
    // A choice by the keyboard leaves the focus where the keyboard goes on.
    if (!state.session && !state.recording) element('list-heading', HTMLElement).focus();
    else this.canvas.focus();
  }

  private open(linked: PageState): void {
    const state = this.publication ? withoutServer(linked) : linked;
    this.linked = state;
    this.at = {
      ...(state.session === undefined ? {} : { session: state.session }),
      ...(state.recording ? { recording: state.recording } : {}),
    };
    this.sessionView.stop();
    this.recordingView.stop();
    this.publicationView.stop();
    this.screen.clear();
    this.playback.play(undefined);
    this.playback.setSpeed(state.speed ?? 1);
    this.playback.setLoops(state.loop === 'on');
    delete this.canvas.dataset.frame;
    delete this.canvas.dataset.triangles;
    delete this.canvas.dataset.particles;
    this.watchKind = 'connecting';
    this.banner.say('');
    const watching = this.looking;
    element('watch', HTMLElement).hidden = !watching;
    element('leave', HTMLButtonElement).hidden = !watching || this.publication !== undefined;
    element('beside', HTMLButtonElement).hidden = this.publication !== undefined;
    if (this.publication) this.heading.showPublication('');
    else if (state.recording) this.heading.showRecording(state.recording);
    else if (state.session !== undefined) this.heading.showSession(state.session);
    else this.heading.showNothing();
    this.offer.withdraw();
    this.sessionOffer.withdraw();
    this.inPlaceOfPicture('');
    // The water alone.
    this.tools.open(this.embedding ? { ...state, scale: 'off', domain: 'off' } : state);
    if (!watching && this.embedding) {
      element('watch', HTMLElement).hidden = false;
      // The page around will say which, once it listens.
      const nothing = this.embedding.page === undefined ? 'No session is chosen.' : '';
      this.inPlaceOfPicture(state.problem ?? nothing);
      return;
    }
    if (!watching) {
      const problem = element('address-problem', HTMLElement);
      problem.textContent = state.problem ?? '';
      problem.hidden = state.problem === undefined;
      this.list.show();
      this.recordings.show();
      return;
    }
    this.list.hide();
    this.recordings.hide();
    this.setLook(state.look ?? 'water');
    this.setParticles(false);
    if (this.publication) this.publicationView.start(this.publication, state.position);
    else if (state.recording) this.recordingView.start(state.recording, state.position);
    else this.sessionView.start(state.session!);
  }

  /** Whether something is looked at, or else the list. */
  private get looking(): boolean {
    return this.publication !== undefined || this.at.session !== undefined || this.at.recording !== undefined;
  }

  private restsAt(position: number): void {
    this.at = { ...this.at, position };
    this.writeAddress();
  }

  private allFrames(): ((signal: AbortSignal) => AsyncIterable<Frame>) | undefined {
    const { recording } = this.at;
    if (this.publication) return (signal) => this.publicationView.allFrames(signal);
    if (!recording) return undefined;
    return (signal) =>
      recordedFrames(this.server.readRecording({ sessionId: recording.session, number: recording.number }, signal));
  }

  private frameDrawn(frame: Frame): void {
    if (!this.screen.frameDrawn(frame)) return;
    this.tools.frameDrawn(frame);
    if (this.publication) this.publicationView.frameDrawn(frame);
    else if (this.at.recording) this.recordingView.frameDrawn(frame);
    else this.sessionView.frameDrawn(frame);
  }

  private firstFrame(): void {
    this.inPlaceOfPicture('');
    // Again: the figures cover a part of the picture now.
    this.place(this.linked.camera);
  }

  /** camera: none where all of the water is to be in view. */
  private place(camera: PageState['camera']): void {
    if (camera) this.viewer.cameraPlace = camera;
    else this.viewer.fit();
  }

  private watchState(state: WatchState): void {
    this.canvas.dataset.state = state.kind;
    this.watchKind = state.kind;
    this.showWhatApplies();
    this.watchIsOver = state.kind === 'token' || state.kind === 'refused';
    this.banner.watching(state);
    this.heading.watching(state);
    if (state.kind === 'ended' || state.kind === 'absent') {
      if (!this.embedding && this.at.session !== undefined) void this.offer.offer(this.at.session);
    } else if (state.kind !== 'connecting') this.offer.withdraw();
    if (state.kind === 'absent' && !this.embedding && !this.screen.shown) void this.sessionOffer.offer();
    else if (state.kind !== 'connecting') this.sessionOffer.withdraw();
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

  private showWhatApplies(): void {
    const played = this.publication !== undefined || this.at.recording !== undefined;
    const playing = played && this.watchKind === 'live';
    this.screen.overlay.setSeen(this.streaming ? 'stream' : playing ? 'playing' : 'resting');
  }

  private cameraMoving(moving: boolean): void {
    this.sessionView.cameraMoving(moving);
    if (!moving) this.writeAddress();
  }

  private inPlaceOfPicture(text: string): void {
    element('in-place-of-picture', HTMLElement).textContent = text;
  }

  private async tokenNeeded(reason: string): Promise<void> {
    if (this.embedding) {
      this.banner.say(reason);
      return;
    }
    if (reason !== '') this.tokenReason = reason;
    // The dialog says it.
    this.banner.say('');
    const token = await askToken(this.server.token !== '', this.tokenReason);
    if (token === undefined) {
      this.banner.tokenNeeded(this.tokenReason);
      return;
    }
    this.server.token = token;
    this.banner.say('');
    if (this.at.recording) this.recordingView.restart();
    else if (this.at.session !== undefined) this.sessionView.restart();
    else this.open({});
    this.tools.restart();
  }

  /** page: its origin; none: the address says what is shown. */
  private embed(page: string | undefined): void {
    document.body.dataset.embedded = '';
    element('list', HTMLElement).hidden = true;
    element('overlay', HTMLElement).hidden = true;
    if (page === undefined) return;
    listenToPage(window, page, crypto.getRandomValues(new Uint32Array(4)).join('-'), {
      show: (handed) => {
        this.showHanded(handed);
      },
      refused: (reason) => {
        this.handingFailed = true;
        this.banner.say(reason);
      },
    });
  }

  private showHanded({ state, token }: HandedOver): void {
    const known = state.session === this.at.session && token === this.server.token;
    this.server.token = token;
    if (!known || this.watchIsOver) {
      this.open(state);
      return;
    }
    // The watch goes on, and its last report holds: a page may move the camera as often as it likes.
    if (this.handingFailed) this.banner.say('');
    this.handingFailed = false;
    this.linked = state;
    this.setLook(state.look ?? 'water');
    this.tools.chooseUp(state.up);
    this.tools.chooseColor(state.color);
    if (this.screen.shown) this.place(state.camera);
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
        this.showFigures(element('overlay', HTMLElement).hidden);
      },
      glb: () => {
        this.save('glb', 'model/gltf-binary');
      },
      ply: () => {
        this.save('ply', 'application/octet-stream');
      },
      link: () => {
        this.writeAddress();
        void copyAddress(element('link', HTMLButtonElement));
      },
    };
    for (const [id, action] of Object.entries(actions))
      element(id, HTMLButtonElement).addEventListener('click', action);
    element('full', HTMLButtonElement).hidden = !document.fullscreenEnabled;
    bindKeys(this.viewer.controls, this.embedding !== undefined, () => this.looking);
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

  private showFigures(shown: boolean): void {
    element('overlay', HTMLElement).hidden = !shown;
    element('measure', HTMLButtonElement).setAttribute('aria-pressed', String(shown));
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
    // The state that a page hands over stays out of the address; a page within a notebook has none.
    if (this.embedding || location.protocol === 'about:' || !this.screen.shown || !this.looking) return;
    history.replaceState(
      null,
      '',
      writeLink({
        ...this.at,
        ...this.tools.state,
        camera: this.viewer.cameraPlace,
        look: this.look,
        speed: this.playback.speed,
        ...(this.playback.loops ? { loop: 'on' } : {}),
      }),
    );
  }
}
