// Which publication this page shows: its own, where it is one; else that of its address, `?publication=URL`.
import { FileMissing, filesAt, filesInPage, type PublicationFiles } from './publication_files';

/** None where the page shows a server's sessions. token: of the server that the page comes from; "": none. */
export function publicationOf(
  page: Document,
  { search, href, origin }: Pick<Location, 'search' | 'href' | 'origin'>,
  token: () => string,
): PublicationFiles | undefined {
  const inPage = filesInPage(page);
  if (inPage) return inPage;
  const beside = page.querySelector<HTMLMetaElement>('meta[name="meniscus-publication"]')?.content;
  const named = beside ?? new URLSearchParams(search).get('publication');
  if (named === null) return undefined;
  const url = parsed(named, href);
  if (url) return filesAt(url, undefined, url.origin === origin ? token : undefined);
  return {
    read: () => Promise.reject(new FileMissing('This address names a publication that cannot be: it is no URL.')),
  };
}

function parsed(url: string, base: string): URL | undefined {
  try {
    const { protocol, href } = new URL(url, base);
    return protocol === 'http:' || protocol === 'https:' ? new URL(href) : undefined;
  } catch {
    return undefined;
  }
}
