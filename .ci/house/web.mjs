// What the page's sources import and which of the browser's words they use, as the TypeScript
// compiler and Svelte's parser see it. Started by .ci/doors:
//   node web.mjs ROOT REPOSITORY < rooms.json    →  findings as JSON: [{file, line, cause}]
// ROOT is the tree that is checked; the compilers come from REPOSITORY/web/node_modules.
import { existsSync, readFileSync, realpathSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, dirname, extname, join, relative, resolve } from 'node:path';

const [root, repository] = process.argv.slice(2).map((p) => realpathSync(p));
const { rooms, files, words } = JSON.parse(readFileSync(0, 'utf8'));
const require = createRequire(join(repository, 'web/package.json'));
const ts = require('typescript');
const svelte = require('svelte/compiler');

const NETWORK = new Set(words.network);
const EVALUATES = new Set(['eval', 'Function', 'importScripts']);
const SCRIPTS = new Set(['.ts', '.js', '.mts', '.mjs', '.cts', '.cjs', '.tsx', '.jsx']);
const findings = [];

const tell = (file, line, cause) => findings.push({ file: relative(root, file), line, cause });
const is_test = (file) => /\.(test|spec)\.[cm]?tsx?$/.test(file);

/** The room of a file: the longest of the table's folders that holds it. */
function room_of(file) {
  const path = relative(root, file);
  let found;
  for (const room of rooms) {
    const inside = path.startsWith(`${room.name}/`);
    if (inside && (found === undefined || room.name.length > found.name.length)) found = room;
  }
  return found?.loose && dirname(path) !== found.name ? undefined : found;
}

const project_of = new Map();
function project(file) {
  const config = ts.findConfigFile(dirname(file), ts.sys.fileExists);
  const key = config ?? '';
  if (!project_of.has(key)) {
    const read = config ? ts.readConfigFile(config, ts.sys.readFile).config : {};
    const parsed = ts.parseJsonConfigFileContent(read, ts.sys, config ? dirname(config) : root);
    // The browser's own words must be known; what is imported need not be read for that.
    const words_only = { noEmit: true, allowJs: true, types: [], noResolve: true };
    const options = { ...parsed.options, ...words_only };
    project_of.set(key, { options, files: [] });
  }
  return project_of.get(key);
}

/** Where a specifier leads: {file} inside the tree, {package}, {node} or {} when nowhere. */
function target(specifier, from) {
  const name = specifier.replace(/[?#].*$/, '') || specifier;
  if (name.startsWith('node:')) return { package: name };
  const { options } = project(from);
  const found = ts.resolveModuleName(name, from, options, ts.sys).resolvedModule;
  let path = found?.resolvedFileName;
  if (path === undefined) {
    const plain = name.startsWith('/') ? join(root, 'web', name) : resolve(dirname(from), name);
    if (name.startsWith('.') || name.startsWith('/')) path = existsSync(plain) ? plain : undefined;
    else {
      try {
        path = createRequire(from).resolve(name);
      } catch {
        const parts = name.split('/');
        return { package: parts.slice(0, name.startsWith('@') ? 2 : 1).join('/'), lost: true };
      }
      if (path === name) return { package: `node:${name}` }; // a built-in without its prefix
    }
  }
  if (path === undefined) return { lost: true };
  const packages = path.split('/node_modules/');
  if (packages.length > 1) {
    const parts = packages.at(-1).split('/');
    return { package: parts.slice(0, parts[0].startsWith('@') ? 2 : 1).join('/') };
  }
  return { file: realpathSync(path) };
}

const matches = (name, allowed) =>
  allowed.some((a) => a === '*' || a === name || (a.endsWith('*') && name.startsWith(a.slice(0, -1))));

function imported(file, line, specifier) {
  const room = room_of(file);
  if (specifier === undefined) return tell(file, line, 'an import whose name is computed');
  if (specifier === '') return tell(file, line, 'an import of nothing');
  const { file: path, package: name, lost } = target(specifier, file);
  if (name !== undefined) {
    const allowed = [...room.packages, ...(is_test(file) ? room.test_packages : [])];
    if (!matches(name, allowed)) tell(file, line, `${room.name} does not import '${specifier}'`);
    return;
  }
  if (lost) {
    // Types made from the API's document may not be there yet.
    if (!specifier.endsWith('/schema')) tell(file, line, `'${specifier}' leads nowhere`);
    return;
  }
  const other = room_of(path);
  if (other === undefined) {
    tell(file, line, `'${specifier}' lies outside every room`);
  } else if (other !== room && !matches(other.name, room.doors)) {
    tell(file, line, `${room.name} has no door to ${other.name}`);
  }
}

const literal = (node) => (node && ts.isStringLiteralLike(node) ? node.text : undefined);

/** Every way in which TypeScript names another module. */
function named_module(node) {
  if (ts.isImportDeclaration(node) || ts.isExportDeclaration(node))
    return node.moduleSpecifier ? [literal(node.moduleSpecifier)] : [];
  if (ts.isImportEqualsDeclaration(node) && ts.isExternalModuleReference(node.moduleReference))
    return [literal(node.moduleReference.expression)];
  if (ts.isImportTypeNode(node)) return [ts.isLiteralTypeNode(node.argument) ? literal(node.argument.literal) : undefined];
  if (ts.isModuleDeclaration(node) && ts.isStringLiteral(node.name)) return node.name.text.startsWith('*') ? [] : [node.name.text];
  if (ts.isNewExpression(node) && node.expression.getText() === 'URL' && /import\.meta/.test(node.arguments?.[1]?.getText() ?? ''))
    return [literal(node.arguments[0])];
  if (!ts.isCallExpression(node)) return [];
  const called = node.expression;
  if (called.kind === ts.SyntaxKind.ImportKeyword) return [literal(node.arguments[0])];
  const text = called.getText().replace(/\s/g, '');
  if (/^import\.meta\.(glob|resolve)/.test(text)) return [undefined];
  if (/^(module\.|globalThis\.)?require(\.resolve)?$/.test(text)) return [literal(node.arguments[0])];
  if (/^vi\.(mock|doMock|importActual|importMock)$/.test(text) && literal(node.arguments[0]) !== undefined)
    return [literal(node.arguments[0])];
  return [];
}

/** The browser's word that a node says, or undefined: a global of lib.dom, by whatever way. */
function browser_word(node, checker) {
  if (ts.isElementAccessExpression(node)) {
    const type = node.expression.getText();
    if (!/^(window|globalThis|self|top|parent|document\.defaultView)!?$/.test(type)) return undefined;
    return literal(node.argumentExpression) ?? '[…]';
  }
  if (!ts.isIdentifier(node)) return undefined;
  const parent = node.parent;
  if (ts.isPropertyAssignment(parent) && parent.name === node) return undefined;
  let symbol = checker.getSymbolAtLocation(node);
  if (symbol && ts.isShorthandPropertyAssignment(parent)) symbol = checker.getShorthandAssignmentValueSymbol(parent);
  if (ts.isBindingElement(parent) && (parent.propertyName ?? parent.name) === node) {
    const type = checker.getTypeAtLocation(parent.parent);
    symbol = type.getProperty(node.text) ?? symbol;
  }
  const declarations = symbol?.declarations ?? [];
  if (declarations.length === 0) return undefined;
  const dom = declarations.every((d) => /lib\.(dom|webworker|scripthost)[^/]*\.d\.ts$/.test(d.getSourceFile().fileName));
  if (!dom) return undefined;
  const global = declarations.some(
    (d) => d.parent?.kind === ts.SyntaxKind.SourceFile || d.parent?.parent?.parent?.kind === ts.SyntaxKind.SourceFile,
  );
  return global || NETWORK.has(node.text) ? node.text : undefined;
}

function judge_word(file, line, word) {
  const room = room_of(file);
  const rule = is_test(file) ? 'any' : room.browser;
  if (EVALUATES.has(word)) tell(file, line, `'${word}' runs text as a program`);
  else if (rule === 'none' && !matches(word, room.browser_words))
    tell(file, line, `${room.name} knows neither page nor network: '${word}'`);
  else if (rule === 'page' && (NETWORK.has(word) || word === '[…]'))
    tell(file, line, `only ${words.network_room} talks to the server: '${word}'`);
}

function script(file, source, checker) {
  const line_of = (node) => source.getLineAndCharacterOfPosition(node.getStart(source)).line + 1;
  for (const list of [source.referencedFiles, source.typeReferenceDirectives])
    for (const reference of list) {
      const line = source.getLineAndCharacterOfPosition(reference.pos).line + 1;
      const path = list === source.referencedFiles && !reference.fileName.startsWith('.') ? `./${reference.fileName}` : reference.fileName;
      imported(file, line, path);
    }
  const visit = (node) => {
    for (const specifier of named_module(node)) imported(file, line_of(node), specifier);
    const word = browser_word(node, checker);
    if (word !== undefined) judge_word(file, line_of(node), word);
    else if (ts.isIdentifier(node) && EVALUATES.has(node.text) && !ts.isTypeNode(node.parent) && !ts.isPropertyAccessExpression(node.parent))
      judge_word(file, line_of(node), node.text);
    ts.forEachChild(node, visit);
  };
  visit(source);
}

const line_at = (text, at) => text.slice(0, at).split('\n').length;

function styles(file, text, offset, whole) {
  const plain = text.replace(/\/\*[\s\S]*?\*\//g, (c) => c.replace(/[^\n]/g, ' '));
  const named = /@import\s+(?:url\(\s*)?['"]?([^'")\s;]+)|url\(\s*['"]?([^'")\s]+)/g;
  for (const found of plain.matchAll(named)) {
    const name = found[1] ?? found[2];
    if (/^(data:|#)/.test(name)) continue;
    const line = line_at(whole, offset + found.index);
    if (/^(https?:)?\/\//.test(name)) tell(file, line, `'${name}' comes from elsewhere: the page works without a network`);
    else imported(file, line, /^[./@]/.test(name) || !existsSync(resolve(dirname(file), name)) ? name : `./${name}`);
  }
}

/** The script blocks of a component as one TypeScript text, every character in its place. */
function script_text(text, ast) {
  const keep = [];
  for (const block of [ast.module, ast.instance]) if (block) keep.push([block.content.start, block.content.end]);
  let out = '';
  for (let at = 0; at < text.length; ++at)
    out += text[at] === '\n' || keep.some(([a, b]) => at >= a && at < b) ? text[at] : ' ';
  return out;
}

function markup(file, text, ast) {
  const seen = new Set();
  const visit = (node, parent) => {
    if (!node || typeof node !== 'object' || seen.has(node)) return;
    seen.add(node);
    if (node === ast.instance || node === ast.module || node === ast.css) return;
    if (Array.isArray(node)) return node.forEach((n) => visit(n, parent));
    if (node.type === 'ImportExpression') imported(file, line_at(text, node.start), typeof node.source.value === 'string' ? node.source.value : undefined);
    if (node.type === 'Identifier' && (NETWORK.has(node.name) || EVALUATES.has(node.name))) {
      const outer = parent?.type === 'MemberExpression' && parent.property === node && !parent.computed;
      const key = parent?.type === 'Property' && parent.key === node && !parent.shorthand;
      if (!key && (!outer || /^(window|globalThis|self|navigator)$/.test(parent.object.name ?? ''))) judge_word(file, line_at(text, node.start), node.name);
    }
    if (node.type === 'RegularElement' && node.name === 'script') tell(file, line_at(text, node.start), 'a script in the markup');
    for (const [key, value] of Object.entries(node)) if (key !== 'parent') visit(value, node);
  };
  visit(ast.fragment, undefined);
  if (ast.css) styles(file, ast.css.content.styles, ast.css.content.start, text);
}

const scripts = new Map(); // virtual or real path → {file, text?}
const components = [];
for (const name of files) {
  const file = join(root, name);
  const room = room_of(file);
  if (room === undefined) {
    tell(file, 1, `${dirname(name)} is no room of this house`);
    continue;
  }
  const kind = extname(name);
  const text = readFileSync(file, 'utf8');
  if (statSync(file).isDirectory()) continue;
  if (kind === '.svelte') {
    let ast;
    try {
      ast = svelte.parse(text, { modern: true, filename: file });
    } catch (error) {
      tell(file, error.start?.line ?? 1, `cannot be read: ${error.message.split('\n')[0]}`);
      continue;
    }
    components.push({ file, text, ast });
    for (const found of text.matchAll(/<script\b[^>]*\bsrc=/g)) tell(file, line_at(text, found.index), 'a script from elsewhere');
    scripts.set(`${file}.ts`, { file, text: script_text(text, ast) });
  } else if (SCRIPTS.has(kind)) scripts.set(file, { file, text });
  else if (kind === '.css') styles(file, text, 0, text);
  else tell(file, 1, `${basename(name)} is of no kind that is looked into here`);
}

for (const [path, { file }] of scripts) project(file).files.push(path);
for (const { options, files: roots } of project_of.values()) {
  if (roots.length === 0) continue;
  const host = ts.createCompilerHost(options, true);
  const read = host.readFile.bind(host);
  const exists = host.fileExists.bind(host);
  const source_file = host.getSourceFile.bind(host);
  const texts = new Map(roots.map((path) => [path, scripts.get(path).text]));
  host.readFile = (path) => texts.get(path) ?? read(path);
  host.fileExists = (path) => texts.has(path) || exists(path);
  host.getSourceFile = (path, target_version, ...rest) =>
    texts.has(path)
      ? ts.createSourceFile(path, texts.get(path), target_version, true)
      : source_file(path, target_version, ...rest);
  const program = ts.createProgram(roots, options, host);
  const checker = program.getTypeChecker();
  for (const path of roots) script(scripts.get(path).file, program.getSourceFile(path), checker);
}
for (const { file, text, ast } of components) markup(file, text, ast);
process.stdout.write(JSON.stringify(findings));
