// Which robot this page belongs to: at its head, in the title of its tab, and as the tab's picture.

import { title_of, type RobotIdentity } from '../model/identity';

export class Identity {
  robot = $state.raw<RobotIdentity | null>(null);

  readonly take = (robot: RobotIdentity | null): void => {
    const before = this.robot;
    if (before?.name === robot?.name && before?.rgb === robot?.rgb) return;
    this.robot = robot;
    document.title = title_of(robot);
    const icon = document.querySelector<HTMLLinkElement>('link[rel="icon"]');
    if (!icon || !robot) return;
    // A picture may be of another kind than the drawing it stands for.
    icon.removeAttribute('type');
    icon.href = robot.picture;
  };
}
