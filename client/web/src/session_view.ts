// One session on the screen: its watch, its bricks, its picture.
import { BrickStore, type Shown } from './bricks/brick_store';
import type { Frame } from './bricks/frame';
import { History } from './bricks/history';
import { levelCount } from './decode/decoded_brick';
import type { DecodePool } from './decode/decode_pool';
import { KeptParticles } from './particles/kept_particles';
import type { Particles } from './particles/particles';
import type { Server } from './rpc/server';
import { LinkSpeed } from './stream/link_speed';
import { ParticleWatch } from './stream/particle_watch';
import { chooseQuality, wishesOf, type Quality } from './stream/quality';
import { SessionWatch } from './stream/session_watch';
import { SkippedFrames } from './stream/skipped_frames';
import type { WatchState } from './stream/watch_state';
import type { Overlay } from './ui/overlay';
import { Playback } from './ui/playback';
import type { Viewer } from './view/viewer';

/** Some ten seconds at 30 frames a second. */
const historyLimits = { frames: 300, bytes: 192 << 20 };
const particleLimits = { frames: 300, bytes: 64 << 20 };

export interface SessionViewEvents {
  state(state: WatchState): void;
  failed(reason: string): void;
  /** A frame is shown again after one that failed. */
  recovered(): void;
  firstFrame(): void;
}

export class SessionView {
  private readonly history = new History(historyLimits);
  private readonly playback: Playback;
  private readonly store: BrickStore;
  private readonly particles = new KeptParticles(particleLimits);
  private particleWatch: ParticleWatch | undefined;
  private particlesWanted = false;
  private particlesFailing = false;
  private link = new LinkSpeed();
  private skipped = new SkippedFrames();
  private watch: SessionWatch | undefined;
  private quality: Quality = 'full';
  private moving = false;
  private failing = false;
  private lastDrawn: Frame | undefined;

  constructor(
    private readonly server: Server,
    pool: DecodePool,
    private readonly viewer: Viewer,
    private readonly overlay: Overlay,
    private readonly events: SessionViewEvents,
  ) {
    this.store = new BrickStore((brick, bits) => pool.decode(brick, bits), {
      shown: (shown) => {
        this.viewer.show(shown);
        this.showParticles();
        if (this.failing) this.events.recovered();
        this.failing = false;
      },
      failed: (error) => {
        this.failing = true;
        this.events.failed(`A mesh could not be shown: ${error instanceof Error ? error.message : String(error)}.`);
      },
    });
    this.playback = new Playback(this.history, {
      paused: () => { this.pauseOrResume(); },
      chosen: (frame) => { this.store.show(frame); },
    });
    document.addEventListener('visibilitychange', () => { this.pauseOrResume(); });
  }

  get shown(): Shown | undefined {
    return this.store.shown;
  }

  start(session: string): void {
    this.stop();
    this.link = new LinkSpeed();
    this.skipped = new SkippedFrames();
    this.watch = new SessionWatch(this.server, session, {}, {
      frame: (frame) => { this.take(frame); },
      state: (state) => { this.events.state(state); },
      received: (bytes) => { this.overlay.receivedBytes(bytes); },
    });
    this.particleWatch = new ParticleWatch(this.server, session, {
      particles: (particles) => {
        this.particles.add(particles);
        this.showParticles();
        this.askForParticles();
        this.particlesRecovered();
      },
      failed: (reason) => {
        this.particlesFailing = true;
        this.events.failed(`The particles cannot be shown: ${reason}`);
      },
      received: (bytes) => { this.overlay.receivedBytes(bytes); },
    });
    this.setQuality('full');
    this.playback.setPaused(false);
    this.watch.start();
  }

  /** With another token, or once more. */
  restart(): void {
    this.watch?.start();
  }

  /** Nothing of the session stays on the screen. */
  stop(): void {
    this.watch?.stop();
    this.watch = undefined;
    this.particleWatch?.setWanted(false);
    this.particleWatch = undefined;
    this.particles.clear();
    this.lastDrawn = undefined;
    this.store.clear();
    this.viewer.clear();
    this.viewer.showParticles(undefined);
    this.overlay.clear();
    this.playback.clear();
  }

  /** Whether particles are shown, in place of the surface. */
  setParticles(wanted: boolean): void {
    this.particlesWanted = wanted;
    if (!wanted) this.particles.clear();
    this.askForParticles();
    this.showParticles();
    this.particlesRecovered();
  }

  togglePause(): void {
    this.playback.toggle();
  }

  step(by: number): void {
    this.playback.step(by);
  }

  cameraMoving(moving: boolean): void {
    this.moving = moving;
    this.adjustQuality();
  }

  /** A picture of the frame has been drawn. */
  frameDrawn(frame: Frame, particles: Particles | undefined): void {
    this.overlay.particlesDrawn(frame, particles);
    if (frame === this.lastDrawn) return;
    const first = !this.lastDrawn;
    this.lastDrawn = frame;
    this.overlay.frameDrawn(frame, this.levels());
    if (!this.playback.paused) {
      this.skipped.shown(frame);
      this.overlay.liveFrameDrawn(frame, this.skipped.count, this.server.roundTrip);
    }
    if (first) this.events.firstFrame();
  }

  private take(frame: Frame): void {
    this.link.add(frame, this.quality === 'full');
    this.history.add(frame);
    this.playback.frameAdded();
    this.store.show(frame);
    this.adjustQuality();
  }

  private adjustQuality(): void {
    if (!this.watch || this.playback.paused || this.link.offsetBits === 0) return;
    const quality = chooseQuality(this.moving, this.link.secondsPerFullMesh, this.quality);
    if (quality === this.quality) return;
    this.setQuality(quality);
    this.watch.setWishes(wishesOf(quality, this.link.offsetBits));
  }

  private setQuality(quality: Quality): void {
    this.quality = quality;
    this.overlay.setQuality({ full: 'full', light: 'fewer bits', coarse: 'fewer bits, level 2' }[quality]);
  }

  private pauseOrResume(): void {
    const paused = this.playback.paused || document.hidden;
    if (paused) this.skipped.pause();
    this.watch?.setPaused(paused);
    this.askForParticles();
  }

  /** While the picture is paused only until there are some. */
  private askForParticles(): void {
    const { shown } = this.store;
    const enough = this.playback.paused && shown && this.particles.nearest(shown.frame);
    this.particleWatch?.setWanted(this.particlesWanted && !enough && !document.hidden);
  }

  private particlesRecovered(): void {
    if (this.particlesFailing) this.events.recovered();
    this.particlesFailing = false;
  }

  /** Those that belong to the mesh on the screen. */
  private showParticles(): void {
    const { shown } = this.store;
    this.viewer.showParticles(this.particlesWanted && shown ? this.particles.nearest(shown.frame) : undefined);
  }

  private levels(): number[] {
    const levels = new Array<number>(levelCount).fill(0);
    for (const { decoded } of this.store.shown?.bricks.values() ?? [])
      decoded.levelTriangles.forEach((count, level) => { levels[level]! += count; });
    return levels;
  }
}
