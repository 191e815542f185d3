// Finnish.

import { checks } from './checks';
import { drive } from './drive';
import { fences } from './fences';
import { guide } from './guide';
import { house } from './house';
import { items } from './items';
import { maps } from './maps';
import { me } from './me';
import { news } from './news';
import { plan } from './plan';
import { robot } from './robot';
import { runs } from './runs';
import { state } from './state';
import { words } from './words';

export const finnish = {
  ...words,
  ...state,
  ...drive,
  ...checks,
  ...items,
  ...plan,
  ...fences,
  ...runs,
  ...maps,
  ...house,
  ...guide,
  ...me,
  ...news,
  ...robot,
} as const;
