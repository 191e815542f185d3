// What is asked for as long as somebody looks at it: the next question comes after the last answer.

/**
 * @param ask an answer comes, and then what is to be done with it
 * @param wait_ms between an answer and the next question
 * @return ends it: an answer that is still under way does nothing any more
 */
export const again_and_again = (ask: () => Promise<() => void>, wait_ms: number): (() => void) => {
  let waiting: ReturnType<typeof setTimeout> | undefined;
  let over = false;
  const again = async (): Promise<void> => {
    const take = await ask();
    if (over) return;
    take();
    waiting = setTimeout(() => void again(), wait_ms);
  };
  void again();
  return () => {
    over = true;
    clearTimeout(waiting);
  };
};
