/** The words of an attribution, which may be written in HTML. */
export const plain_text = (html: string): string =>
  new DOMParser().parseFromString(html, 'text/html').body.textContent;
