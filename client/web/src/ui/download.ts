// Hands a file to the person.

export function download(name: string, type: string, bytes: Uint8Array): void {
  const url = URL.createObjectURL(new Blob([bytes as BlobPart], { type }));
  const anchor = document.createElement('a');
  anchor.href = url;
  anchor.download = name;
  anchor.click();
  // After the browser has taken it.
  setTimeout(() => {
    URL.revokeObjectURL(url);
  }, 60_000);
}
