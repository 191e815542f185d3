/** What a browser has and this program lacks, as far as GeoTIFFs are read by it. */
class Reader {
  result: ArrayBuffer | null = null;
  onload: (() => void) | null = null;
  onerror: (() => void) | null = null;
  onabort: (() => void) | null = null;

  readAsArrayBuffer(blob: Blob): void {
    void blob.arrayBuffer().then((bytes) => {
      this.result = bytes;
      this.onload?.();
    });
  }
}

export const file_reader = (): void => {
  Object.assign(globalThis, { FileReader: Reader });
};
