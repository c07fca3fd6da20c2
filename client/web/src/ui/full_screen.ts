// The whole page, not the picture alone: what goes wrong is to be read in full screen, too.

export async function toggleFullScreen(): Promise<void> {
  if (document.fullscreenElement) await document.exitFullscreen();
  else await document.documentElement.requestFullscreen();
}
