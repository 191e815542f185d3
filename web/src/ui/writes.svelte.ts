// Whether the person at this page may change what the robot keeps: said at the buttons, before one is
// pressed for nothing.

class Writes {
  /** null: he may, as far as his role goes. */
  why_not = $state<string | null>(null);
}

export const writes = new Writes();
