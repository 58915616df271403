// The words of the page in English and German.

const WORDS = {
  en: {
    scene: "Scene", picture: "Picture", otherPicture: "The picture that it is compared with", tree: "Rays", space: "In space", accelerator: "Accelerator", inspector: "Pixel",
    waiting: "connecting …", lost: "The connection to strahl is lost. The page tries again; if strahl has ended, start `strahl view` again.", loading: "reading the scene …", rendering: "rendering",
    rays: "rays",
    color: "Colour", normal: "Normals", depth: "Depth", object: "Objects", material: "Materials", levels: "Levels of the tree", tests: "Tests",
    steps: "Steps", rayCount: "Rays", time: "Time",
    channel: "Channel", exposure: "Exposure", sampling: "Antialiasing", maxDepth: "Depth", cutoff: "Cutoff", shading: "Shading", size: "Size",
    materialIs: "material", own: "as in scene", camera: "Camera", copyCamera: "Copy camera", resetCamera: "Reset", copied: "copied",
    compare: "Compare", savePng: "PNG", help: "Help", theme: "Light or dark", language: "Deutsch", export: "Export",
    background: "background", line: "line", pixel: "pixel", of: "of", sample: "sample", samples: "samples", counts: "counts", noPixel: "Click a pixel to see where its colour comes from.",
    primary: "primary ray", reflection: "reflection ray", transparency: "transparency ray", shadow: "shadow ray", blockedRay: "blocked shadow ray", eye: "eye", adds: "adds",
    linear: "linear", sum: "The rays add up to", level: "level", weight: "weight", origin: "origin", direction: "direction", point: "point", normalIs: "normal",
    medium: "runs through", noHit: "It hits nothing: the background is",
    visible: "visible", blocked: "blocked by", weakened: "weakened by", behind: "behind the surface", noLight: "no light arrives", at: "at", ambient: "ambient", emission: "emission",
    diffuse: "diffuse", highlight: "highlight", local: "own light", total: "total", ended: "not followed", totalReflection: "Total reflection: Snell's law has no solution, sin θ₂ would be",
    why: "Why is it dark here?", dark: "dark", ofRays: "shadow rays", kept: "transmittance", fog: "fog", finish: "POV-Ray's finish", layer: "layer", model: "shading model",
    meanOf: "mean of %n points of the light",
    error: "error", warning: "warning", warnings: "warnings", lastGood: "The last good picture is shown.",
    edit: "Try", stopEdit: "Drop changes", save: "Save", saved: "saved", tryHint: "Changes stay in this page", openEditor: "Editor", tooLong: "not shown",
    play: "Play", pause: "Pause", all: "All", perspective: "Perspective", orthographic: "Orthographic", stepOf: "step",
    node: "node", leaf: "leaf", cell: "cell", test: "test", hits: "hits", misses: "misses", sphere: "sphere", "leaf sphere": "leaf sphere", "empty block": "empty block", "enter instance": "enter instance", "leave instance": "leave instance",
    exit: "exit face", region: "region", clock: "Clock", swipe: "a line to drag", beside: "side by side", view: "Shown", more: "More", curve: "Tone curve", srgb: "none: as in the file", reinhard: "Reinhard", filmic: "filmic", table: "Table", tableTitle: "The cost of the picture with each accelerator", measuring: "measuring …", build: "building", seconds: "tracing", stepsPerRay: "steps a ray", testsPerRay: "tests a ray", samePictures: "all pictures are the same, bit for bit", otherPictures: "the pictures differ", saveExr: "EXR, linear", treeSvg: "Tree as SVG", from: "from", to: "to", frames: "pictures", settingsOf: "Compared with", width: "Width", none: "none", marked: "pixels of line",
    objects: "objects", lights: "Lights", lightCount: "lights", oneLight: "light", oneObject: "object", near: "Go near this step; without a step, show all", stepCount: "steps", testCount: "tests", close: "Close",
    copyLight: "Copy light", noLights: "No light of this scene has a position.", dragLight: "Drag it, or use the wheel: nearer or away.", resetHint: "Camera and lights as in the scene",
    savePage: "Page, HTML", savePageHint: "The picture with its objects and the ray trees of some pixels, as a page that needs no server", exporting: "The page is being made …",
    builtIn: "a part of strahl", pixelAt: "The tree of the pixel", nearest: "the nearest one that has its tree here", treesHere: "pixels have their ray trees in this page: click one", texts: "Scene",
    helpTitle: "Keys and mouse",
    helpList: [
      ["drag, wheel", "move and zoom the picture"], ["click, tap", "the ray tree of a pixel"], ["two fingers", "move and zoom"], ["arrow keys", "the pixel beside it"],
      ["C", "camera: drag turns, Shift+drag moves, wheel goes nearer; again: inspect"], ["G", "lights: drag moves the chosen light, wheel moves it nearer or away; again: inspect"], ["R", "camera and lights as in the scene"], ["F", "fit the picture"], ["1", "one to one"],
      ["+ −", "exposure"], ["N D O M", "normals, depth, objects, materials; again: colour"], ["X", "compare two settings"],
      ["S", "show or hide the scene's text"], ["I", "show or hide the inspector"], ["T", "light or dark"], ["L", "English or German"], ["Space", "play or pause the rays in space"], [", .", "step back, step on"], ["?", "this sheet"], ["Esc", "close, unmark"],
    ],
  },
  de: {
    // What the server says in English.
    "depth limit": "Tiefengrenze", "weight below the cutoff": "Gewicht unter der Abbruchgrenze", "total internal reflection": "Totalreflexion", "limit of rays per sample": "zu viele Strahlen",
    "point light": "Punktlicht", "area light": "Flächenlicht", "spot light": "Scheinwerfer", "parallel light": "paralleles Licht", "cylindrical light": "zylindrisches Licht", light: "Licht",
    scene: "Szene", picture: "Bild", otherPicture: "Das Bild, mit dem es verglichen wird", tree: "Strahlen", space: "Im Raum", accelerator: "Beschleunigung", inspector: "Bildpunkt",
    waiting: "verbinde …", lost: "Die Verbindung zu strahl ist weg. Die Seite versucht es weiter; ist strahl beendet, starte `strahl view` neu.", loading: "liest die Szene …", rendering: "rechnet",
    rays: "Strahlen",
    color: "Farbe", normal: "Normalen", depth: "Tiefe", object: "Objekte", material: "Materialien", levels: "Stufen des Baums", tests: "Tests",
    steps: "Schritte", rayCount: "Strahlen", time: "Zeit",
    channel: "Kanal", exposure: "Belichtung", sampling: "Glättung", maxDepth: "Tiefe", cutoff: "Abbruch", shading: "Beleuchtung", size: "Größe",
    materialIs: "Material", own: "wie Szene", camera: "Kamera", copyCamera: "Kamera kopieren", resetCamera: "Zurück", copied: "kopiert",
    compare: "Vergleichen", savePng: "PNG", help: "Hilfe", theme: "Hell oder dunkel", language: "English", export: "Exportieren",
    background: "Hintergrund", line: "Zeile", pixel: "Bildpunkt", of: "von", sample: "Abtastung", samples: "Abtastungen", counts: "zählt", noPixel: "Klicke auf einen Bildpunkt, um zu sehen, woher seine Farbe kommt.",
    primary: "Primärstrahl", reflection: "Reflexionsstrahl", transparency: "Transparenzstrahl", shadow: "Schattenstrahl", blockedRay: "verdeckter Schattenstrahl", eye: "Auge", adds: "trägt bei",
    linear: "linear", sum: "Die Strahlen ergeben zusammen", level: "Stufe", weight: "Gewicht", origin: "Ursprung", direction: "Richtung", point: "Punkt", normalIs: "Normale",
    medium: "läuft durch", noHit: "Er trifft nichts: der Hintergrund ist",
    visible: "sichtbar", blocked: "verdeckt von", weakened: "geschwächt von", behind: "hinter der Fläche", noLight: "es kommt kein Licht an", at: "bei", ambient: "ambient", emission: "Emission",
    diffuse: "diffus", highlight: "Glanzlicht", local: "eigenes Licht", total: "Summe", ended: "nicht verfolgt", totalReflection: "Totalreflexion: Das Brechungsgesetz hat keine Lösung, sin θ₂ wäre",
    why: "Warum ist es hier dunkel?", dark: "dunkel", ofRays: "Schattenstrahlen", kept: "Durchlässigkeit", fog: "Nebel", finish: "POV-Rays Finish", layer: "Schicht", model: "Beleuchtungsmodell",
    meanOf: "Mittel aus %n Punkten der Lichtquelle",
    error: "Fehler", warning: "Warnung", warnings: "Warnungen", lastGood: "Das letzte gute Bild bleibt stehen.",
    edit: "Probieren", stopEdit: "Änderungen verwerfen", save: "Sichern", saved: "gesichert", tryHint: "Änderungen bleiben in dieser Seite", openEditor: "Editor", tooLong: "nicht gezeigt",
    play: "Abspielen", pause: "Anhalten", all: "Alle", perspective: "Perspektive", orthographic: "Orthographisch", stepOf: "Schritt",
    node: "Knoten", leaf: "Blatt", cell: "Zelle", test: "Test", hits: "trifft", misses: "verfehlt", sphere: "Kugel", "leaf sphere": "Blattkugel", "empty block": "leerer Block", "enter instance": "betritt Instanz", "leave instance": "verlässt Instanz",
    exit: "Austrittsfläche", region: "Bereich", clock: "Uhr", swipe: "Linie zum Ziehen", beside: "nebeneinander", view: "Ansicht", more: "Mehr", curve: "Tonkurve", srgb: "keine: wie in der Datei", reinhard: "Reinhard", filmic: "filmisch", table: "Tabelle", tableTitle: "Was das Bild mit jeder Beschleunigung kostet", measuring: "misst …", build: "Aufbau", seconds: "Verfolgen", stepsPerRay: "Schritte je Strahl", testsPerRay: "Tests je Strahl", samePictures: "alle Bilder sind gleich, Bit für Bit", otherPictures: "die Bilder unterscheiden sich", saveExr: "EXR, linear", treeSvg: "Baum als SVG", from: "von", to: "bis", frames: "Bilder", settingsOf: "Verglichen mit", width: "Breite", none: "keine", marked: "Bildpunkte der Zeile",
    objects: "Objekte", lights: "Lichter", lightCount: "Lichter", oneLight: "Licht", oneObject: "Objekt", near: "Nah an diesen Schritt heran; ohne Schritt alles zeigen", stepCount: "Schritte", testCount: "Tests", close: "Schließen",
    copyLight: "Licht kopieren", noLights: "Kein Licht dieser Szene hat einen Ort.", dragLight: "Ziehen, oder mit dem Rad näher oder weiter weg.", resetHint: "Kamera und Lichter wie in der Szene",
    savePage: "Seite, HTML", savePageHint: "Das Bild mit seinen Objekten und den Strahlenbäumen einiger Bildpunkte, als Seite, die keinen Server braucht", exporting: "Die Seite wird geschrieben …",
    builtIn: "ein Teil von strahl", pixelAt: "Der Baum des Bildpunkts", nearest: "des nächsten, der hier einen Baum hat", treesHere: "Bildpunkte haben ihre Strahlenbäume in dieser Seite: klicke auf einen", texts: "Szene",
    helpTitle: "Tasten und Maus",
    helpList: [
      ["ziehen, Rad", "Bild verschieben und vergrößern"], ["Klick, Tippen", "Strahlenbaum eines Bildpunkts"], ["zwei Finger", "verschieben und vergrößern"], ["Pfeiltasten", "der Bildpunkt daneben"],
      ["C", "Kamera: ziehen dreht, Umschalt+ziehen verschiebt, Rad geht näher; nochmals: untersuchen"], ["G", "Lichter: ziehen bewegt das gewählte Licht, das Rad bringt es näher oder weiter weg; nochmals: untersuchen"], ["R", "Kamera und Lichter wie in der Szene"], ["F", "Bild einpassen"], ["1", "eins zu eins"],
      ["+ −", "Belichtung"], ["N D O M", "Normalen, Tiefe, Objekte, Materialien; nochmals: Farbe"], ["X", "zwei Einstellungen vergleichen"],
      ["S", "Text der Szene zeigen oder verbergen"], ["I", "Untersuchung zeigen oder verbergen"], ["T", "hell oder dunkel"], ["L", "Englisch oder Deutsch"], ["Leertaste", "Strahlen im Raum abspielen oder anhalten"], [", .", "Schritt zurück, Schritt weiter"], ["?", "diese Hilfe"], ["Esc", "schließen, Markierung löschen"],
    ],
  },
};

let language = "en";

export function setLanguage(name) {
  language = name === "de" ? "de" : "en";
}

export function getLanguage() {
  return language;
}

// The name of a light: those without one are numbered.
export function lightName(name) {
  return name.replace(/^light(?= \d)/, word("oneLight"));
}

export function word(key) {
  return WORDS[language][key] ?? WORDS.en[key] ?? key;
}
