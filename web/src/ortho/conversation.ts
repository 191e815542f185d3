// The worker that cuts an orthophoto into tiles, as a conversation.

import type { Asked, Looked, Told } from './messages';

export type Tile = Extract<Told, { kind: 'tile' }>;
type Trouble = Extract<Told, { kind: 'trouble' }>;

export interface Cutter {
  look(file: File): Promise<Looked | Trouble>;
  /** @param take returns false: no more */
  cut(take: (tile: Tile) => Promise<boolean>): Promise<Trouble | null>;
  end(): void;
}

export const start_cutter = (): Cutter => {
  const worker = new Worker(new URL('./cutter.ts', import.meta.url), { type: 'module' });
  const ask = (asked: Asked): void => worker.postMessage(asked);
  const failed = (detail: string): Trouble => ({ kind: 'trouble', why: 'unreadable', detail });
  const heard = (): Promise<Told> =>
    new Promise((resolve) => {
      worker.onmessage = ({ data }: MessageEvent<Told>) => resolve(data);
      worker.onerror = ({ message }) => resolve(failed(message));
    });
  return {
    look: async (file) => {
      const answer = heard();
      ask({ kind: 'look', file });
      const told = await answer;
      if (told.kind === 'looked') return told.is;
      return told.kind === 'trouble' ? told : failed('');
    },
    cut: async (take) => {
      let answer = heard();
      ask({ kind: 'cut' });
      for (;;) {
        const told = await answer;
        if (told.kind === 'trouble') return told;
        if (told.kind !== 'tile' || !(await take(told))) return null;
        answer = heard();
        ask({ kind: 'next' });
      }
    },
    end: () => worker.terminate(),
  };
};
