import type { OrthoTrouble } from './messages';

export class Trouble extends Error {
  constructor(
    readonly why: OrthoTrouble,
    detail = '',
  ) {
    super(detail);
  }
}
