// Draws lines and words over the picture that stand out before whatever is behind them.

export interface Pen {
  readonly context: CanvasRenderingContext2D;
  readonly color: string;
  /** Around what is drawn. */
  readonly halo: string;
}

/** points: x y each, CSS pixels. */
export function drawLine({ context, color, halo }: Pen, points: readonly (readonly [number, number])[]): void {
  context.beginPath();
  points.forEach(([x, y], i) => {
    if (i === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.lineJoin = context.lineCap = 'round';
  context.strokeStyle = halo;
  context.lineWidth = 5;
  context.stroke();
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.stroke();
}

export function drawRing({ context, color, halo }: Pen, [x, y]: readonly [number, number], radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.strokeStyle = halo;
  context.lineWidth = 5;
  context.stroke();
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.stroke();
}

/** Its middle is there. */
export function drawText({ context, color, halo }: Pen, text: string, [x, y]: readonly [number, number]): void {
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.strokeStyle = halo;
  context.lineWidth = 4;
  context.strokeText(text, x, y);
  context.fillStyle = color;
  context.fillText(text, x, y);
}
