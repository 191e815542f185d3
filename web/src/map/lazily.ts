// Parts of the map that most pages never need.

/** @return loads it when it is wanted first; what did not come is asked for again the next time */
export const lazily = <T>(load: () => Promise<T>, take: (part: T) => void): (() => void) => {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    load().then(take, () => (asked = false));
  };
};
