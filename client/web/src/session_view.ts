// One session on the screen: its watch, the last of its frames.
import type { Frame } from './bricks/frame';
import { History } from './bricks/history';
import { KeptParticles } from './particles/kept_particles';
import type { Server } from './rpc/server';
import type { Screen } from './screen';
import { LinkSpeed } from './stream/link_speed';
import { ParticleWatch } from './stream/particle_watch';
import { chooseQuality, watchOptions, type Quality } from './stream/quality';
import { SessionWatch } from './stream/session_watch';
import { SkippedFrames } from './stream/skipped_frames';
import type { WatchState } from './stream/watch_state';
import type { Playback, Reel } from './ui/playback';
import { frameText } from './ui/texts';

/** Some ten seconds at 30 frames a second. */
const historyLimits = { frames: 300, bytes: 192 << 20 };
const particleLimits = { frames: 300, bytes: 64 << 20 };

export interface SessionViewEvents {
  state(state: WatchState): void;
  failed(reason: string): void;
  /** Particles come again after a failure. */
  recovered(): void;
}

export class SessionView {
  private readonly history = new History(historyLimits);
  private readonly particles = new KeptParticles(particleLimits);
  private particleWatch: ParticleWatch | undefined;
  private particlesWanted = false;
  private particlesFailing = false;
  private link = new LinkSpeed();
  private skipped = new SkippedFrames();
  private watch: SessionWatch | undefined;
  private quality: Quality = 'full';
  private moving = false;
  private attribute: string | undefined;

  constructor(
    private readonly server: Server,
    private readonly screen: Screen,
    private readonly playback: Playback,
    private readonly events: SessionViewEvents,
  ) {
    document.addEventListener('visibilitychange', () => {
      this.pauseOrResume();
    });
  }

  start(session: string): void {
    this.stop();
    this.link = new LinkSpeed();
    this.skipped = new SkippedFrames();
    this.watch = new SessionWatch(this.server, session, watchOptions('full', 0, this.attribute), {
      frame: (frame) => {
        this.take(frame);
      },
      state: (state) => {
        this.events.state(state);
      },
      received: (bytes) => {
        this.screen.overlay.receivedBytes(bytes);
      },
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
      received: (bytes) => {
        this.screen.overlay.receivedBytes(bytes);
      },
    });
    this.setQuality('full');
    this.playback.play(this.reel());
    this.playback.setPaused(false);
    this.watch.start();
  }

  /** With another token, or once more. */
  restart(): void {
    this.watch?.start();
  }

  /** Nothing of the session stays. */
  stop(): void {
    this.watch?.stop();
    this.watch = undefined;
    this.particleWatch?.setWanted(false);
    this.particleWatch = undefined;
    this.particles.clear();
    this.history.clear();
  }

  /** That vertices are to carry; of this session, and of those that follow. */
  setAttribute(name: string | undefined): void {
    if (name === this.attribute) return;
    this.attribute = name;
    this.watch?.setOptions(watchOptions(this.quality, this.link.offsetBits, name));
  }

  /** Whether particles are shown, in place of the surface. */
  setParticles(wanted: boolean): void {
    this.particlesWanted = wanted;
    if (!wanted) this.particles.clear();
    this.askForParticles();
    this.showParticles();
    this.particlesRecovered();
  }

  cameraMoving(moving: boolean): void {
    this.moving = moving;
    this.adjustQuality();
  }

  /** The frame's first picture has been drawn. */
  frameDrawn(frame: Frame): void {
    if (!this.watch || this.playback.paused) return;
    const at = this.history.frames.indexOf(frame);
    if (at >= 0) this.playback.moveTo(at);
    this.skipped.shown(frame);
    this.screen.overlay.liveFrameDrawn(frame, this.skipped.count, this.server.roundTrip);
  }

  private reel(): Reel {
    const { frames } = this.history;
    return {
      get length() {
        return frames.length;
      },
      describe: (at) => frameText(frames[at]!),
      choose: (at) => {
        this.screen.show(frames[at]!);
      },
      paused: (paused) => {
        // What came last is drawn yet.
        if (paused && frames.length > 0) this.playback.moveTo(frames.length - 1);
        this.pauseOrResume();
      },
      resume: 'Resume',
    };
  }

  private take(frame: Frame): void {
    this.link.add(frame, this.quality === 'full');
    this.history.add(frame);
    this.screen.show(frame);
    this.adjustQuality();
  }

  private adjustQuality(): void {
    if (!this.watch || this.playback.paused || this.link.offsetBits === 0) return;
    const quality = chooseQuality(this.moving, this.link.secondsPerFullMesh, this.quality);
    if (quality === this.quality) return;
    this.setQuality(quality);
    this.watch.setOptions(watchOptions(quality, this.link.offsetBits, this.attribute));
  }

  private setQuality(quality: Quality): void {
    this.quality = quality;
    this.screen.overlay.setQuality({ full: 'full', light: 'fewer bits', coarse: 'fewer bits, level 2' }[quality]);
  }

  private pauseOrResume(): void {
    const paused = this.playback.paused || document.hidden;
    if (paused) this.skipped.pause();
    this.watch?.setPaused(paused);
    this.askForParticles();
  }

  /** While the picture is paused only until there are some. */
  private askForParticles(): void {
    const { shown } = this.screen;
    const enough = this.playback.paused && shown && this.particles.nearest(shown.frame);
    this.particleWatch?.setWanted(this.particlesWanted && !enough && !document.hidden);
  }

  private particlesRecovered(): void {
    if (this.particlesFailing) this.events.recovered();
    this.particlesFailing = false;
  }

  /** Shows the particles that belong to the mesh on the screen. */
  showParticles(): void {
    const { shown } = this.screen;
    this.screen.showParticles(this.particlesWanted && shown ? this.particles.nearest(shown.frame) : undefined);
  }
}
