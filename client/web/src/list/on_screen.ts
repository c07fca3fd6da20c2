// Which items of a list are on the screen.

export class OnScreen {
  private readonly ids = new Map<Element, string>();
  private readonly observer: IntersectionObserver;

  constructor(changed: (id: string, visible: boolean) => void) {
    this.observer = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const id = this.ids.get(target);
        if (id !== undefined) changed(id, isIntersecting);
      }
    });
  }

  add(item: Element, id: string): void {
    this.ids.set(item, id);
    this.observer.observe(item);
  }

  remove(item: Element): void {
    this.ids.delete(item);
    this.observer.unobserve(item);
  }
}
