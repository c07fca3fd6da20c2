// Copies the page's address, and says so on the button for a moment.

export async function copyAddress(button: HTMLButtonElement): Promise<void> {
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
