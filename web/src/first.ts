// The first that runs, and small: the document's stop button stops before the page is here.

import { first_stop } from './link/first_stop';
import './ui/style.css';
import './ui/first.css';

first_stop.listen(document.querySelector('#first [data-stop]'));

const AGAIN_MS = 2000;
/** Where the network is lost on the way: the stop button stays, and the page comes when it can. */
const bring_page = (): void => {
  import('./main').catch(() => setTimeout(bring_page, AGAIN_MS));
};
bring_page();
