// Names for requests that may have to be repeated.

/** Also where a page has no secure context. */
export const fresh_key = (): string =>
  [...crypto.getRandomValues(new Uint8Array(16))]
    .map((byte) => byte.toString(16).padStart(2, '0'))
    .join('');
