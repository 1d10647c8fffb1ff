<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de">
<context>
    <name>Banner</name>
    <message>
        <source>Dismiss this message</source>
        <translation>Diese Meldung schließen</translation>
    </message>
</context>
<context>
    <name>BeforeAndAfter</name>
    <message>
        <source>Error of a pixel before and after</source>
        <translation>Fehler eines Pixels vorher und nachher</translation>
    </message>
    <message>
        <source>Parameters before and after</source>
        <translation>Parameter vorher und nachher</translation>
    </message>
    <message>
        <source>Distance between a point&apos;s images before and after, after the rotation that
brings the two closest where corners (dots) were seen.</source>
        <translation>Abstand der Bilder eines Punktes vorher und nachher, nach der Drehung,
die beide dort am nächsten zusammenbringt, wo Ecken (Punkte) gesehen wurden.</translation>
    </message>
    <message>
        <source>&amp;Keep</source>
        <translation>&amp;Behalten</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>&amp;Zurücknehmen</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is {1} times smaller</source>
        <translation>{0}: der Fehler dort, wo Ecken sind, ist {1}-mal kleiner</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is not smaller</source>
        <translation>{0}: der Fehler dort, wo Ecken sind, ist nicht kleiner</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>Vorher</translation>
    </message>
    <message>
        <source>After</source>
        <translation>Nachher</translation>
    </message>
    <message>
        <source>Change</source>
        <translation>Änderung</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.</source>
        <translation>Geteilt durch die Standardabweichung einer Differenz unabhängiger Schätzungen.</translation>
    </message>
    <message>
        <source>The difference is being computed.</source>
        <translation>Der Unterschied wird berechnet.</translation>
    </message>
    <message>
        <source>Error, {0} [px]</source>
        <translation>Fehler, {0} [px]</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>Mitte</translation>
    </message>
    <message>
        <source>among corners</source>
        <translation>bei Ecken</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>Rand</translation>
    </message>
    <message>
        <source>worst</source>
        <translation>größter</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Urteil</translation>
    </message>
</context>
<context>
    <name>BoardList</name>
    <message>
        <source>Boards</source>
        <translation>Bretter</translation>
    </message>
    <message>
        <source>Add a &amp;board</source>
        <translation>&amp;Brett hinzufügen</translation>
    </message>
    <message>
        <source>Re&amp;move</source>
        <translation>Entfe&amp;rnen</translation>
    </message>
    <message>
        <source>A further board that stands fast to the first and is told from it by its markers or tags</source>
        <translation>Ein weiteres Brett, das fest zum ersten steht und sich durch seine Marker oder Tags von ihm unterscheidet</translation>
    </message>
    <message>
        <source>As the photo&amp;graphs show it</source>
        <translation>Wie die F&amp;otos es zeigen</translation>
    </message>
    <message>
        <source>Take the board that the photographs show; turn it off to state it.</source>
        <translation>Das Brett nehmen, das die Fotos zeigen; zum Angeben ausschalten.</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation type="unfinished">nicht angegeben</translation>
    </message>
    <message>
        <source> mm</source>
        <translation type="unfinished"> mm</translation>
    </message>
    <message>
        <source>taken as {0} mm</source>
        <translation>gilt als {0} mm</translation>
    </message>
    <message>
        <source>Not measured if 0: all lengths then hold for squares so long</source>
        <translation>Bei 0 nicht gemessen: Alle Längen gelten dann für so lange Quadrate</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation type="unfinished">Seite eines Quadrats</translation>
    </message>
    <message>
        <source>Stands where I &amp;know</source>
        <translation>Sein Ort ist be&amp;kannt</translation>
    </message>
    <message>
        <source>State where the board stands beside the first one; turn it off to have that estimated with the rig.</source>
        <translation>Angeben, wo das Brett neben dem ersten steht; ausgeschaltet wird es mit dem Rig geschätzt.</translation>
    </message>
    <message>
        <source>{0}, mm</source>
        <translation>{0}, mm</translation>
    </message>
    <message>
        <source>rotation vector, {0}, degrees</source>
        <translation>Drehvektor, {0}, Grad</translation>
    </message>
    <message>
        <source>Beside board 1, in mm and degrees:</source>
        <translation>Neben Brett 1, in mm und Grad:</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>Brett {0}</translation>
    </message>
</context>
<context>
    <name>BoardPanel</name>
    <message>
        <source>&amp;Counted in the images</source>
        <translation>In den Bildern &amp;gezählt</translation>
    </message>
    <message>
        <source>Take the size that most images show; turn it off to state it.</source>
        <translation>Die Größe nehmen, die die meisten Bilder zeigen; zum Angeben ausschalten.</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>Zeilen innerer Ecken</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>Spalten innerer Ecken</translation>
    </message>
    <message>
        <source>Corners where four squares meet: one fewer than squares each way.</source>
        <translation>Ecken, an denen vier Quadrate zusammentreffen: je Richtung eine weniger als Quadrate.</translation>
    </message>
    <message>
        <source>Side of one square. Only the distances depend on it: measure several squares together and divide.</source>
        <translation>Seite eines Quadrats. Nur Entfernungen hängen davon ab: mehrere Quadrate zusammen messen und teilen.</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Seite eines Quadrats</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exakt</translation>
    </message>
    <message>
        <source>One standard deviation of the side, which all squares share: every length is uncertain by the same share. A certificate&apos;s U (k = 2) is twice as much.</source>
        <translation>Eine Standardabweichung der Seite, die alle Quadrate teilen: jede Länge ist um denselben Anteil unsicher. Das U eines Zertifikats (k = 2) ist doppelt so groß.</translation>
    </message>
    <message>
        <source>Standard deviation of the side of a square</source>
        <translation>Standardabweichung der Seite eines Quadrats</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>by their edges</source>
        <translation>an ihren Kanten</translation>
    </message>
    <message>
        <source>Fit the edges that cross at each corner, as exactly as the noise allows, and tell how exact that is.</source>
        <translation>Die Kanten, die sich an jeder Ecke kreuzen, so genau anpassen, wie das Rauschen erlaubt, und sagen, wie genau das ist.</translation>
    </message>
    <message>
        <source>by the saddle point</source>
        <translation>am Sattelpunkt</translation>
    </message>
    <message>
        <source>As the paper does: the saddle point of the grey levels at each corner.</source>
        <translation>Wie im Aufsatz: der Sattelpunkt der Grauwerte an jeder Ecke.</translation>
    </message>
    <message>
        <source>How corners are located; another way searches anew.</source>
        <translation>Wie Ecken gefunden werden; ein anderer Weg sucht neu.</translation>
    </message>
    <message>
        <source>all rows</source>
        <translation>alle Zeilen</translation>
    </message>
    <message>
        <source>odd rows</source>
        <translation>ungerade Zeilen</translation>
    </message>
    <message>
        <source>even rows</source>
        <translation>gerade Zeilen</translation>
    </message>
    <message>
        <source>Search one field of interlaced frames, in which edges that moved between the two are not combed. The rows between are interpolated.</source>
        <translation>Ein Halbbild verschränkter Bilder absuchen, in dem bewegte Kanten nicht ausgefranst sind. Die Zeilen dazwischen werden interpoliert.</translation>
    </message>
    <message>
        <source>Mar&amp;k all by hand</source>
        <translation>Alle von &amp;Hand markieren</translation>
    </message>
    <message>
        <source>Images are not searched: point at each board&apos;s four outermost corners (M), and Enter goes on to the next image.</source>
        <translation>Bilder werden nicht abgesucht: auf die vier äußersten Ecken jedes Bretts zeigen (M); Enter geht zum nächsten Bild.</translation>
    </message>
    <message>
        <source>read from the images</source>
        <translation>aus den Bildern gelesen</translation>
    </message>
    <message>
        <source>Loca&amp;ted</source>
        <translation>&amp;Gefunden</translation>
    </message>
    <message>
        <source>Interlaced</source>
        <translation>Verschränkt</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>Was auf das Brett gedruckt ist.</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Zahl der Ecken</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>Muster</translation>
    </message>
    <message>
        <source>Way to locate corners</source>
        <translation>Weg, Ecken zu finden</translation>
    </message>
    <message>
        <source>Rows of interlaced frames</source>
        <translation>Zeilen verschränkter Bilder</translation>
    </message>
    <message>
        <source>Mark by hand</source>
        <translation>Von Hand markieren</translation>
    </message>
    <message>
        <source>Search the images</source>
        <translation>Bilder absuchen</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>Größe der Quadrate</translation>
    </message>
    <message>
        <source>Uncertainty of squares</source>
        <translation>Unsicherheit der Quadrate</translation>
    </message>
    <message>
        <source>Unit of squares</source>
        <translation>Einheit der Quadrate</translation>
    </message>
</context>
<context>
    <name>BoardScreen</name>
    <message>
        <source>Board on the screen</source>
        <translation>Brett auf dem Bildschirm</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>Length of the line</source>
        <translation>Länge der Linie</translation>
    </message>
    <message>
        <source>&amp;Close (Esc)</source>
        <translation>&amp;Schließen (Esc)</translation>
    </message>
    <message>
        <source>Measure the line above with a ruler:</source>
        <translation>Die Linie oben mit einem Lineal messen:</translation>
    </message>
    <message>
        <source>A square is {0} pixels: {1} mm. State this length.</source>
        <translation>Ein Quadrat ist {0} Pixel groß: {1} mm. Diese Länge angeben.</translation>
    </message>
    <message>
        <source>Circles are {0} pixels apart: {1} mm. State this length.</source>
        <translation>Kreise sind {0} Pixel auseinander: {1} mm. Diese Länge angeben.</translation>
    </message>
</context>
<context>
    <name>BoardShapeChoice</name>
    <message>
        <source>Shape of the board</source>
        <translation>Form des Bretts</translation>
    </message>
    <message>
        <source>as drawn</source>
        <translation>wie gezeichnet</translation>
    </message>
    <message>
        <source>Flat and printed true (nominal). Its errors become the camera&apos;s.</source>
        <translation>Eben und maßhaltig gedruckt (nominal). Seine Fehler werden die der Kamera.</translation>
    </message>
    <message>
        <source>stretched or askew</source>
        <translation>gestreckt oder schief</translation>
    </message>
    <message>
        <source>Sides of unequal scale, not quite at right angles (affine).</source>
        <translation>Seiten ungleichen Maßstabs, nicht ganz rechtwinklig (affine).</translation>
    </message>
    <message>
        <source>bowed</source>
        <translation>gewölbt</translation>
    </message>
    <message>
        <source>Bent along rows and columns (bow).</source>
        <translation>Entlang der Zeilen und Spalten gebogen (bow).</translation>
    </message>
    <message>
        <source>free: every corner</source>
        <translation>frei: jede Ecke</translation>
    </message>
    <message>
        <source>Every corner is estimated in three dimensions (free). Needs 6 views, and every corner in 4 of them, or a prior.</source>
        <translation>Jede Ecke wird dreidimensional geschätzt (free). Braucht 6 Ansichten und jede Ecke in 4 davon, oder Vorwissen.</translation>
    </message>
    <message>
        <source>what predicts best</source>
        <translation>was am besten vorhersagt</translation>
    </message>
    <message>
        <source>Of these, the one that predicts views best that it has not seen. Slow.</source>
        <translation>Davon das, was ungesehene Ansichten am besten vorhersagt. Langsam.</translation>
    </message>
    <message>
        <source>as in a file…</source>
        <translation>wie in einer Datei…</translation>
    </message>
    <message>
        <source>Hold a shape that was saved before.</source>
        <translation>Eine früher gespeicherte Form festhalten.</translation>
    </message>
    <message>
        <source>known to</source>
        <translation>bekannt auf</translation>
    </message>
    <message>
        <source> mm in plane</source>
        <translation> mm in der Ebene</translation>
    </message>
    <message>
        <source>Standard deviation of the print in the plane, mm</source>
        <translation>Standardabweichung des Drucks in der Ebene, mm</translation>
    </message>
    <message>
        <source> mm off plane</source>
        <translation> mm quer dazu</translation>
    </message>
    <message>
        <source>Standard deviation out of the plane: flatness, mm</source>
        <translation>Standardabweichung quer zur Ebene: Ebenheit, mm</translation>
    </message>
    <message>
        <source>State how far corners may be from where they should be: in the plane, and out of it. Every ± counts it, and few views can then carry a free board.</source>
        <translation>Angeben, wie weit Ecken von ihrem Sollort sein dürfen: in der Ebene und quer dazu. Jedes ± zählt es mit, und wenige Ansichten können dann ein freies Brett tragen.</translation>
    </message>
    <message>
        <source>Boar&amp;d is</source>
        <translation>B&amp;rett ist</translation>
    </message>
    <message>
        <source>as in a file: {0:.2g} mm off</source>
        <translation>wie in Datei: {0:.2g} mm Abweichung</translation>
    </message>
    <message>
        <source>The board&apos;s shape</source>
        <translation>Die Form des Bretts</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>Formen (*.json)</translation>
    </message>
</context>
<context>
    <name>BoardShapePanel</name>
    <message>
        <source>Board shape</source>
        <translation>Brettform</translation>
    </message>
    <message>
        <source>How the real board deviates from its drawing.</source>
        <translation>Wie das echte Brett von seiner Zeichnung abweicht.</translation>
    </message>
    <message>
        <source>&amp;Save shape…</source>
        <translation>Form &amp;speichern…</translation>
    </message>
    <message>
        <source>Write the board&apos;s shape to a file, for later calibrations with the same board: Set-up, Board is: as in a file.</source>
        <translation>Die Form des Bretts in eine Datei schreiben, für spätere Kalibrierungen mit demselben Brett: Einrichtung, Brett ist: wie in einer Datei.</translation>
    </message>
    <message>
        <source>X on the board</source>
        <translation>X auf dem Brett</translation>
    </message>
    <message>
        <source>Y on the board</source>
        <translation>Y auf dem Brett</translation>
    </message>
    <message>
        <source>Arrows: from where corners should be to where they are, magnified.
Colours: out of the plane; red is away from the camera.</source>
        <translation>Pfeile: vom Sollort der Ecken zu ihrem Ort, vergrößert.
Farben: quer zur Ebene; Rot ist von der Kamera weg.</translation>
    </message>
    <message>
        <source>The board was taken as drawn. To estimate its shape, choose “free” or another model at “Board is” in the Set-up and calibrate again.</source>
        <translation>Das Brett wurde wie gezeichnet genommen. Um seine Form zu schätzen, bei „Brett ist“ in der Einrichtung „frei“ oder ein anderes Modell wählen und neu kalibrieren.</translation>
    </message>
    <message>
        <source>out of the plane [{0}]</source>
        <translation>quer zur Ebene [{0}]</translation>
    </message>
    <message>
        <source>{0:g} mm in the plane</source>
        <translation>{0:g} mm in der Ebene</translation>
    </message>
    <message>
        <source> Each is known to ± {0:.2g} mm (1σ, median).</source>
        <translation> Jede ist auf ± {0:.2g} mm bekannt (1σ, Median).</translation>
    </message>
    <message>
        <source>Point at a corner to read it.</source>
        <translation>Zum Ablesen auf eine Ecke zeigen.</translation>
    </message>
    <message>
        <source>({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm</source>
        <translation>({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm</translation>
    </message>
    <message>
        <source>Save the board&apos;s shape</source>
        <translation>Form des Bretts speichern</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>Formen (*.json)</translation>
    </message>
</context>
<context>
    <name>BugDialog</name>
    <message>
        <source>Something went wrong</source>
        <translation>Etwas ist schiefgegangen</translation>
    </message>
    <message>
        <source>This is a fault of the program, not of your images. Your work has been kept. Please report the text below; you can go on, or save and start again.</source>
        <translation>Das ist ein Fehler des Programms, nicht Ihrer Bilder. Ihre Arbeit ist gesichert. Bitte melden Sie den Text unten; Sie können weitermachen oder speichern und neu starten.</translation>
    </message>
    <message>
        <source>What to report</source>
        <translation>Was zu melden ist</translation>
    </message>
    <message>
        <source>&amp;Copy</source>
        <translation>&amp;Kopieren</translation>
    </message>
</context>
<context>
    <name>Calibrator</name>
    <message>
        <source>Calibrating</source>
        <translation>Kalibrieren</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>Linsenmodelle vergleichen</translation>
    </message>
    <message>
        <source>Making the camera better</source>
        <translation>Die Kamera verbessern</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>Kalibrierung</translation>
    </message>
    <message>
        <source>Known camera</source>
        <translation>Bekannte Kamera</translation>
    </message>
    <message>
        <source>No board is marked yet, and the search is off.</source>
        <translation>Noch ist kein Brett markiert, und die Suche ist aus.</translation>
    </message>
    <message>
        <source>Mark the four outermost corners in at least three photographs (Mark board), or turn “Mark all by hand” off.</source>
        <translation>Die vier äußersten Ecken in mindestens drei Fotos markieren (Brett markieren) oder „Alle von Hand markieren“ ausschalten.</translation>
    </message>
    <message>
        <source>None of the photographs can be read.</source>
        <translation>Keines der Fotos ist lesbar.</translation>
    </message>
    <message>
        <source>Click on one to see why, or add others.</source>
        <translation>Auf eines klicken, um den Grund zu sehen, oder andere hinzufügen.</translation>
    </message>
    <message>
        <source>There is no image to calibrate from.</source>
        <translation>Es gibt kein Bild zum Kalibrieren.</translation>
    </message>
    <message>
        <source>Add photographs of a board.</source>
        <translation>Fotos eines Bretts hinzufügen.</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>Kamera verbessern</translation>
    </message>
    <message>
        <source>Calibrate</source>
        <translation>Kalibrieren</translation>
    </message>
    <message>
        <source>Stopped: “{0}” is the best so far, not the optimum.</source>
        <translation>Angehalten: „{0}“ ist das Beste bisher, nicht das Optimum.</translation>
    </message>
</context>
<context>
    <name>CameraValues</name>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>Jede Kalibrierung behält ihr Ergebnis unter einem Namen</translation>
    </message>
    <message>
        <source>manage</source>
        <translation>verwalten</translation>
    </message>
    <message>
        <source>Rename, delete or compare results</source>
        <translation>Ergebnisse umbenennen, löschen oder vergleichen</translation>
    </message>
    <message>
        <source>&amp;Compare with</source>
        <translation>&amp;Vergleichen mit</translation>
    </message>
    <message>
        <source>&amp;Rename…</source>
        <translation>&amp;Umbenennen…</translation>
    </message>
    <message>
        <source>&amp;Delete</source>
        <translation>&amp;Löschen</translation>
    </message>
    <message>
        <source>All values, correlations, the paper&apos;s units ›</source>
        <translation>Alle Werte, Korrelationen, Einheiten ›</translation>
    </message>
    <message>
        <source>Show everything that is known of this result</source>
        <translation>Alles zeigen, was von diesem Ergebnis bekannt ist</translation>
    </message>
    <message>
        <source>Still good? Check with new photographs ›</source>
        <translation>Noch gut? Mit neuen Fotos prüfen ›</translation>
    </message>
    <message>
        <source>Or drop them here: they check the camera, and join no project</source>
        <translation>Oder hier ablegen: sie prüfen die Kamera und gehören zu keinem Projekt</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
</context>
<context>
    <name>Canvas</name>
    <message>
        <source>Photograph</source>
        <translation>Foto</translation>
    </message>
</context>
<context>
    <name>CheckSheet</name>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>Change from which the camera counts as changed, px rms</source>
        <translation>Änderung, ab der die Kamera als verändert gilt, px (RMS)</translation>
    </message>
    <message>
        <source>C&amp;heck with others…</source>
        <translation>Mit &amp;anderen prüfen…</translation>
    </message>
    <message>
        <source>&amp;Close</source>
        <translation>&amp;Schließen</translation>
    </message>
    <message>
        <source>&amp;Limit</source>
        <translation>&amp;Grenze</translation>
    </message>
    <message>
        <source>Images ({0})</source>
        <translation>Bilder ({0})</translation>
    </message>
    <message>
        <source>New photographs of the board</source>
        <translation>Neue Fotos des Bretts</translation>
    </message>
    <message>
        <source>Checking the camera</source>
        <translation>Kamera prüfen</translation>
    </message>
    <message>
        <source>These photographs cannot be used</source>
        <translation>Diese Fotos taugen nicht zum Prüfen</translation>
    </message>
    <message>
        <source>Is the camera still good?</source>
        <translation>Ist die Kamera noch gut?</translation>
    </message>
    <message>
        <source>The photographs are searched for the board. They join no project.</source>
        <translation>Die Fotos werden nach dem Brett abgesucht. Sie gehören zu keinem Projekt.</translation>
    </message>
    <message>
        <source>STILL GOOD</source>
        <translation>NOCH GUT</translation>
    </message>
    <message>
        <source>CALIBRATE AGAIN</source>
        <translation>NEU KALIBRIEREN</translation>
    </message>
    <message>
        <source>TAKE OTHER PHOTOGRAPHS</source>
        <translation>ANDERE FOTOS MACHEN</translation>
    </message>
    <message>
        <source>{0} of {1} photographs, the stored camera as it is: RMS {2:.3f} px, σ {3:.3f} px of {4:,} corners.</source>
        <translation>{0} von {1} Fotos, mit der gespeicherten Kamera: RMS {2:.3f} px, σ {3:.3f} px von {4:,} Ecken.</translation>
    </message>
</context>
<context>
    <name>Commands</name>
    <message>
        <source>&amp;Images</source>
        <translation>&amp;Bilder</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;New project</source>
        <translation>&amp;Neues Projekt</translation>
    </message>
    <message>
        <source>Begin with nothing</source>
        <translation>Leer beginnen</translation>
    </message>
    <message>
        <source>&amp;Open project…</source>
        <translation>Projekt ö&amp;ffnen…</translation>
    </message>
    <message>
        <source>Open a saved project</source>
        <translation>Ein gespeichertes Projekt öffnen</translation>
    </message>
    <message>
        <source>Open &amp;recent</source>
        <translation>&amp;Zuletzt geöffnet</translation>
    </message>
    <message>
        <source>Open f&amp;leet…</source>
        <translation>F&amp;lotte öffnen…</translation>
    </message>
    <message>
        <source>Show the cameras of a ledger that calibgui batch wrote</source>
        <translation>Die Kameras eines Verzeichnisses zeigen, das calibgui batch geschrieben hat</translation>
    </message>
    <message>
        <source>Open the sa&amp;mple</source>
        <translation>&amp;Beispiel öffnen</translation>
    </message>
    <message>
        <source>Rendered photographs, to look around</source>
        <translation>Gerechnete Fotos zum Umsehen</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>&amp;Speichern</translation>
    </message>
    <message>
        <source>Write the project to its file</source>
        <translation>Das Projekt in seine Datei schreiben</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>Speichern &amp;unter…</translation>
    </message>
    <message>
        <source>Write the project to another file</source>
        <translation>Das Projekt in eine andere Datei schreiben</translation>
    </message>
    <message>
        <source>Add &amp;images…</source>
        <translation>B&amp;ilder hinzufügen…</translation>
    </message>
    <message>
        <source>Choose image files</source>
        <translation>Bilddateien wählen</translation>
    </message>
    <message>
        <source>Add a &amp;folder…</source>
        <translation>&amp;Ordner hinzufügen…</translation>
    </message>
    <message>
        <source>Take all images of a folder</source>
        <translation>Alle Bilder eines Ordners nehmen</translation>
    </message>
    <message>
        <source>P&amp;hotograph live…</source>
        <translation>Live &amp;fotografieren…</translation>
    </message>
    <message>
        <source>Take photographs with a camera that says where to hold the board</source>
        <translation>Mit einer Kamera fotografieren, die sagt, wohin das Brett soll</translation>
    </message>
    <message>
        <source>Several &amp;cameras…</source>
        <translation>Mehrere &amp;Kameras…</translation>
    </message>
    <message>
        <source>Calibrate cameras that stand fast to each other: a rig</source>
        <translation>Kameras kalibrieren, die fest zueinander stehen: ein Rig</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>Be&amp;enden</translation>
    </message>
    <message>
        <source>Close the window</source>
        <translation>Das Fenster schließen</translation>
    </message>
    <message>
        <source>Projects and folders that were opened stand here</source>
        <translation>Geöffnete Projekte und Ordner stehen hier</translation>
    </message>
    <message>
        <source>No project or folder has been opened yet.</source>
        <translation>Noch wurde kein Projekt oder Ordner geöffnet.</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Noch keine</translation>
    </message>
    <message>
        <source>Open this project or folder</source>
        <translation>Dieses Projekt oder diesen Ordner öffnen</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>B&amp;earbeiten</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>&amp;Rückgängig</translation>
    </message>
    <message>
        <source>Take the last change back</source>
        <translation>Die letzte Änderung zurücknehmen</translation>
    </message>
    <message>
        <source>Nothing has been changed since the project was opened.</source>
        <translation>Seit dem Öffnen des Projekts wurde nichts geändert.</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>&amp;Wiederholen</translation>
    </message>
    <message>
        <source>Do what was undone</source>
        <translation>Zurückgenommenes wieder tun</translation>
    </message>
    <message>
        <source>Nothing has been undone.</source>
        <translation>Nichts wurde zurückgenommen.</translation>
    </message>
    <message>
        <source>&amp;Paste paths</source>
        <translation>&amp;Pfade einfügen</translation>
    </message>
    <message>
        <source>Add the files on the clipboard</source>
        <translation>Die Dateien der Zwischenablage hinzufügen</translation>
    </message>
    <message>
        <source>Copy &amp;table</source>
        <translation>&amp;Tabelle kopieren</translation>
    </message>
    <message>
        <source>Put the table in sight on the clipboard, for a spreadsheet</source>
        <translation>Die sichtbare Tabelle in die Zwischenablage legen, für eine Tabellenkalkulation</translation>
    </message>
    <message>
        <source>No table is in sight: choose a panel with one first.</source>
        <translation>Keine Tabelle ist zu sehen: erst eine Ansicht mit einer wählen.</translation>
    </message>
    <message>
        <source>Copy p&amp;lot as picture</source>
        <translation>&amp;Diagramm als Bild kopieren</translation>
    </message>
    <message>
        <source>Put a picture of the plot in sight on the clipboard</source>
        <translation>Ein Bild des sichtbaren Diagramms in die Zwischenablage legen</translation>
    </message>
    <message>
        <source>No plot is in sight: choose a panel with one first.</source>
        <translation>Kein Diagramm ist zu sehen: erst eine Ansicht mit einem wählen.</translation>
    </message>
    <message>
        <source>Cali&amp;bration</source>
        <translation>&amp;Kalibrierung</translation>
    </message>
    <message>
        <source>&amp;Calibrate</source>
        <translation>&amp;Kalibrieren</translation>
    </message>
    <message>
        <source>Do everything that is still to do</source>
        <translation>Alles tun, was noch zu tun ist</translation>
    </message>
    <message>
        <source>There are no images yet: add some first.</source>
        <translation>Noch gibt es keine Bilder: erst welche hinzufügen.</translation>
    </message>
    <message>
        <source>S&amp;top</source>
        <translation>&amp;Anhalten</translation>
    </message>
    <message>
        <source>End what the progress bar tells of; what is finished stays</source>
        <translation>Beenden, wovon der Balken berichtet; Fertiges bleibt</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>&amp;Exportieren…</translation>
    </message>
    <message>
        <source>Write the camera for OpenCV, ROS, MATLAB or another program</source>
        <translation>Die Kamera für OpenCV, ROS, MATLAB oder ein anderes Programm schreiben</translation>
    </message>
    <message>
        <source>Nothing is calibrated yet: press Calibrate first.</source>
        <translation>Noch ist nichts kalibriert: erst Kalibrieren drücken.</translation>
    </message>
    <message>
        <source>&amp;Report…</source>
        <translation>&amp;Bericht…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page, or a certificate</source>
        <translation>Was bekannt ist als PDF oder Webseite schreiben, oder ein Zertifikat</translation>
    </message>
    <message>
        <source>Chec&amp;k with new photographs…</source>
        <translation>Mit neuen Fotos &amp;prüfen…</translation>
    </message>
    <message>
        <source>Whether the camera is still good; the project stays as it is</source>
        <translation>Ob die Kamera noch gut ist; das Projekt bleibt, wie es ist</translation>
    </message>
    <message>
        <source>&amp;Series of calibrations…</source>
        <translation>&amp;Reihe von Kalibrierungen…</translation>
    </message>
    <message>
        <source>How a camera varies with zoom, focus, temperature or date</source>
        <translation>Wie sich eine Kamera mit Zoom, Fokus, Temperatur oder Datum ändert</translation>
    </message>
    <message>
        <source>&amp;Hand and eye…</source>
        <translation>&amp;Hand und Auge…</translation>
    </message>
    <message>
        <source>Where the camera is in a robot&apos;s hand, or beside the robot</source>
        <translation>Wo die Kamera in der Hand eines Roboters ist, oder neben dem Roboter</translation>
    </message>
    <message>
        <source>&amp;Print a board…</source>
        <translation>Brett &amp;drucken…</translation>
    </message>
    <message>
        <source>Make a board of any size</source>
        <translation>Ein Brett jeder Größe machen</translation>
    </message>
    <message>
        <source>As the &amp;system</source>
        <translation>Wie das &amp;System</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Hell</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Dunkel</translation>
    </message>
    <message>
        <source>Choose light or dark colours</source>
        <translation>Helle oder dunkle Farben wählen</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>S&amp;how panel</source>
        <translation>Ansicht &amp;zeigen</translation>
    </message>
    <message>
        <source>The &amp;desk alone, or back</source>
        <translation>Nur den &amp;Tisch, oder zurück</translation>
    </message>
    <message>
        <source>Hide the strip of images and the inspector, or show them again</source>
        <translation>Bildstreifen und Seitenleiste ausblenden oder wieder zeigen</translation>
    </message>
    <message>
        <source>&amp;Colours</source>
        <translation>&amp;Farben</translation>
    </message>
    <message>
        <source>What the window can show stands here</source>
        <translation>Was das Fenster zeigen kann, steht hier</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>&amp;Manual</source>
        <translation>&amp;Handbuch</translation>
    </message>
    <message>
        <source>How to photograph, what a message means, who reads which file</source>
        <translation>Wie man fotografiert, was eine Meldung bedeutet, wer welche Datei liest</translation>
    </message>
    <message>
        <source>Take the &amp;tour</source>
        <translation>&amp;Rundgang</translation>
    </message>
    <message>
        <source>Two minutes from one part of the window to the next</source>
        <translation>Zwei Minuten von einem Teil des Fensters zum nächsten</translation>
    </message>
    <message>
        <source>&amp;Find an action…</source>
        <translation>&amp;Befehl finden…</translation>
    </message>
    <message>
        <source>Search everything that the menus can do</source>
        <translation>Alles durchsuchen, was die Menüs können</translation>
    </message>
</context>
<context>
    <name>ComparePanel</name>
    <message>
        <source>Compare</source>
        <translation>Vergleichen</translation>
    </message>
    <message>
        <source>Two results side by side: parameters, difference over the image, one image by both.</source>
        <translation>Zwei Ergebnisse nebeneinander: Parameter, Unterschied über dem Bild, ein Bild mit beiden.</translation>
    </message>
    <message>
        <source>Left result</source>
        <translation>Linkes Ergebnis</translation>
    </message>
    <message>
        <source>Right result</source>
        <translation>Rechtes Ergebnis</translation>
    </message>
    <message>
        <source>Parameters of both results</source>
        <translation>Parameter beider Ergebnisse</translation>
    </message>
    <message>
        <source>One image undistorted by both results</source>
        <translation>Ein Bild, mit beiden Ergebnissen entzerrt</translation>
    </message>
    <message>
        <source>Parameters</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Difference [px]</source>
        <translation>Unterschied [px]</translation>
    </message>
    <message>
        <source>Split image</source>
        <translation>Geteiltes Bild</translation>
    </message>
    <message>
        <source>and</source>
        <translation>und</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>Jede Kalibrierung behält ihr Ergebnis unter einem Namen</translation>
    </message>
    <message>
        <source>There is one result. Calibrate again with other settings or other images, and compare the two here.</source>
        <translation>Es gibt ein Ergebnis. Mit anderen Einstellungen oder Bildern neu kalibrieren und beide hier vergleichen.</translation>
    </message>
    <message>
        <source>Comparing…</source>
        <translation>Vergleichen…</translation>
    </message>
    <message>
        <source>Comparing {0} and {1}</source>
        <translation>{0} und {1} vergleichen</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Unterschied</translation>
    </message>
    <message>
        <source>{1} less {0}</source>
        <translation>{1} minus {0}</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>in σ</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.
Results from the same images share their errors: even 1 is much then.</source>
        <translation>Geteilt durch die Standardabweichung einer Differenz unabhängiger Schätzungen.
Ergebnisse aus denselben Bildern teilen ihre Fehler: dann ist schon 1 viel.</translation>
    </message>
    <message>
        <source>differs by more than 3 σ</source>
        <translation>unterscheidet sich um mehr als 3 σ</translation>
    </message>
    <message>
        <source>Where corners were seen the two image the same point up to {0} px apart, {1} px RMS.</source>
        <translation>Wo Ecken gesehen wurden, bilden beide denselben Punkt bis zu {0} px auseinander ab, {1} px RMS.</translation>
    </message>
    <message>
        <source>Of the parameters {0} differs most, by {1:.1f} σ.</source>
        <translation>Von den Parametern unterscheidet sich {0} am meisten, um {1:.1f} σ.</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>{0} entzerren</translation>
    </message>
</context>
<context>
    <name>ConvergencePanel</name>
    <message>
        <source>Convergence</source>
        <translation>Konvergenz</translation>
    </message>
    <message>
        <source>The cost after each step, also while it runs.</source>
        <translation>Die Kosten nach jedem Schritt, auch während er läuft.</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>Iteration</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>Kosten c</translation>
    </message>
    <message>
        <source>The sum of squared residuals that Stage II minimises, after each step.</source>
        <translation>Die Summe der quadrierten Residuen, die Stufe II kleinmacht, nach jedem Schritt.</translation>
    </message>
    <message>
        <source>Calibrating…</source>
        <translation>Kalibrieren…</translation>
    </message>
    <message>
        <source>Calibrating: iteration {0}, RMS residual {1:.4f} {2}</source>
        <translation>Kalibrieren: Iteration {0}, RMS-Residuum {1:.4f} {2}</translation>
    </message>
    <message>
        <source>The camera is known from a file: nothing was solved.</source>
        <translation>Die Kamera ist aus einer Datei bekannt: nichts wurde gelöst.</translation>
    </message>
    <message>
        <source>Weighted RMS residual {0:.4f} {1}; {2}.</source>
        <translation>Gewichtetes RMS-Residuum {0:.4f} {1}; {2}.</translation>
    </message>
    <message>
        <source>RMS residual {0:.4f} {1}; {2}.</source>
        <translation>RMS-Residuum {0:.4f} {1}; {2}.</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>Referenz-px</translation>
    </message>
    <message>
        <source>Converged after {0} iterations.</source>
        <translation>Nach {0} Iterationen konvergiert.</translation>
    </message>
    <message>
        <source>Converged after {0} iterations, with assumptions on what the views leave open.</source>
        <translation>Nach {0} Iterationen konvergiert, mit Annahmen zu dem, was die Ansichten offenlassen.</translation>
    </message>
    <message>
        <source>Stopped after {0} iterations: the best so far is kept, but it is not the optimum.</source>
        <translation>Nach {0} Iterationen angehalten: das Beste bisher bleibt, ist aber nicht das Optimum.</translation>
    </message>
    <message>
        <source>Not converged: all {0} iterations were used. Allow more, or hold parameters that the views do not determine.</source>
        <translation>Nicht konvergiert: alle {0} Iterationen sind verbraucht. Mehr erlauben, oder Parameter festhalten, die die Ansichten nicht bestimmen.</translation>
    </message>
</context>
<context>
    <name>CornerBar</name>
    <message>
        <source>&amp;Done</source>
        <translation>&amp;Fertig</translation>
    </message>
    <message>
        <source>Drag a corner to move it, Delete removes it, a click on a red ring finds it again. Ctrl: do not snap.</source>
        <translation>Eine Ecke ziehen, um sie zu verschieben; Entf entfernt sie, ein Klick auf einen roten Ring findet sie wieder. Strg: nicht einrasten.</translation>
    </message>
    <message>
        <source>&amp;Turn 90°</source>
        <translation>Um 90° &amp;drehen</translation>
    </message>
    <message>
        <source>Count from the board&apos;s next corner</source>
        <translation>Von der nächsten Ecke des Bretts an zählen</translation>
    </message>
    <message>
        <source>F&amp;lip</source>
        <translation>&amp;Spiegeln</translation>
    </message>
    <message>
        <source>Count columns from the other end: for mirrored images</source>
        <translation>Spalten vom anderen Ende zählen: für gespiegelte Bilder</translation>
    </message>
</context>
<context>
    <name>CostChoice</name>
    <message>
        <source>error in the image</source>
        <translation>Fehler im Bild</translation>
    </message>
    <message>
        <source>Distance between measured and predicted corners, px. The noise is in the image: this gives the smallest standard deviations.</source>
        <translation>Abstand gemessener und vorhergesagter Ecken, px. Das Rauschen ist im Bild: das gibt die kleinsten Standardabweichungen.</translation>
    </message>
    <message>
        <source>error on the reference plane</source>
        <translation>Fehler auf der Referenzebene</translation>
    </message>
    <message>
        <source>Distance between the corners registered on the board and where they should be. Far and tilted views weigh more.</source>
        <translation>Abstand der Ecken auf dem Brett von ihrem Sollort. Ferne und geneigte Ansichten wiegen mehr.</translation>
    </message>
    <message>
        <source>as printed in the paper</source>
        <translation>wie im Aufsatz gedruckt</translation>
    </message>
    <message>
        <source>The formulation of the paper to the letter, to reproduce its tables.</source>
        <translation>Die Formulierung des Aufsatzes Wort für Wort, um seine Tabellen nachzurechnen.</translation>
    </message>
    <message>
        <source>Minimise</source>
        <translation>Minimieren</translation>
    </message>
</context>
<context>
    <name>CoveragePanel</name>
    <message>
        <source>Coverage</source>
        <translation>Abdeckung</translation>
    </message>
    <message>
        <source>What the views cover of the image, of tilts and distances, and which to add next.</source>
        <translation>Was die Ansichten vom Bild, von Neigungen und Entfernungen erfassen, und welche als Nächstes fehlt.</translation>
    </message>
    <message>
        <source>Where corners were seen. The lens correction is extrapolated beyond them.</source>
        <translation>Wo Ecken gesehen wurden. Jenseits davon ist die Linsenkorrektur extrapoliert.</translation>
    </message>
    <message>
        <source>tilt to the right</source>
        <translation>Neigung nach rechts</translation>
    </message>
    <message>
        <source>tilt upwards</source>
        <translation>Neigung nach oben</translation>
    </message>
    <message>
        <source>Each view&apos;s tilt, towards the side of the board that is farther away.
Points on all sides, 20° to 45° out, determine the focal length best.</source>
        <translation>Die Neigung jeder Ansicht, zur ferneren Seite des Bretts.
Punkte auf allen Seiten, 20° bis 45° außen, bestimmen die Brennweite am besten.</translation>
    </message>
    <message>
        <source>view</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>Entfernung</translation>
    </message>
    <message>
        <source>From the camera to the middle of the corners seen.</source>
        <translation>Von der Kamera zur Mitte der gesehenen Ecken.</translation>
    </message>
    <message>
        <source>circles in a cell</source>
        <translation>Kreise je Feld</translation>
    </message>
    <message>
        <source>corners in a cell</source>
        <translation>Ecken je Feld</translation>
    </message>
    <message>
        <source>view (distance in mm{0})</source>
        <translation>Ansicht (Entfernung in mm{0})</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Which view would help most? Working…</source>
        <translation>Welche Ansicht hülfe am meisten? Rechnet…</translation>
    </message>
    <message>
        <source>Looking for the next view</source>
        <translation>Die nächste Ansicht suchen</translation>
    </message>
    <message>
        <source>Which view would help most was not examined.</source>
        <translation>Welche Ansicht am meisten hülfe, wurde nicht untersucht.</translation>
    </message>
    <message>
        <source>The next view (red): {0} {1}</source>
        <translation>Die nächste Ansicht (rot): {0} {1}</translation>
    </message>
    <message>
        <source>The next view (red): {0} It hardly lowers the uncertainty of {1} px.</source>
        <translation>Die nächste Ansicht (rot): {0} Sie senkt die Unsicherheit von {1} px kaum.</translation>
    </message>
    <message>
        <source>The next view (red): {0} It lowers the uncertainty over the image from {1} to {2} px.</source>
        <translation>Die nächste Ansicht (rot): {0} Sie senkt die Unsicherheit über dem Bild von {1} auf {2} px.</translation>
    </message>
</context>
<context>
    <name>Detector</name>
    <message>
        <source>Finding corners</source>
        <translation>Ecken finden</translation>
    </message>
    <message>
        <source>Detect again</source>
        <translation>Neu suchen</translation>
    </message>
    <message>
        <source>The search was stopped: {0} of {1} images have been searched. Calibrate searches the others.</source>
        <translation>Die Suche wurde angehalten: {0} von {1} Bildern sind abgesucht. Kalibrieren sucht die anderen ab.</translation>
    </message>
</context>
<context>
    <name>DifferenceMap</name>
    <message>
        <source>difference [px]</source>
        <translation>Unterschied [px]</translation>
    </message>
    <message>
        <source>Distance between a far point&apos;s images by the two calibrations that are compared,
after the rotation that brings the two closest where corners (dots) were seen.</source>
        <translation>Abstand der Bilder eines fernen Punktes in den beiden verglichenen Kalibrierungen,
nach der Drehung, die beide dort am nächsten zusammenbringt, wo Ecken (Punkte) gesehen wurden.</translation>
    </message>
    <message>
        <source>The two calibrations do not differ (below {0:g} px).</source>
        <translation>Die beiden Kalibrierungen unterscheiden sich nicht (unter {0:g} px).</translation>
    </message>
    <message>
        <source>At most {0} px near corners: point to read it</source>
        <translation>Höchstens {0} px nahe Ecken: zum Ablesen zeigen</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: {2:.3f} px</source>
        <translation>u {0:.0f}, v {1:.0f}: {2:.3f} px</translation>
    </message>
</context>
<context>
    <name>DistortionPanel</name>
    <message>
        <source>Distortion</source>
        <translation>Verzeichnung</translation>
    </message>
    <message>
        <source>How far the lens moves each pixel from where an ideal camera would see it.</source>
        <translation>Wie weit die Linse jedes Pixel von dort verschiebt, wo eine ideale Kamera es sähe.</translation>
    </message>
    <message>
        <source>Complete</source>
        <translation>Vollständig</translation>
    </message>
    <message>
        <source>Radial part</source>
        <translation>Radialer Teil</translation>
    </message>
    <message>
        <source>Decentering part</source>
        <translation>Dezentrierung</translation>
    </message>
    <message>
        <source>Part of the distortion</source>
        <translation>Teil der Verzeichnung</translation>
    </message>
    <message>
        <source>Radial: along rays from the centre. Decentering: from lenses out of line.</source>
        <translation>Radial: entlang Strahlen von der Mitte. Dezentrierung: von Linsen, die nicht fluchten.</translation>
    </message>
    <message>
        <source>Only &amp;where corners were seen</source>
        <translation>&amp;Nur wo Ecken gesehen wurden</translation>
    </message>
    <message>
        <source>Beyond the corners&apos; convex hull the correction is an extrapolation.</source>
        <translation>Jenseits der Hülle der Ecken ist die Korrektur eine Extrapolation.</translation>
    </message>
    <message>
        <source>displacement d [px]</source>
        <translation>Verschiebung d [px]</translation>
    </message>
    <message>
        <source>+ array&apos;s centre   × principal point   → gradient</source>
        <translation>+ Sensormitte   × Bildhauptpunkt   → Gradient</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})</source>
        <translation>u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})</translation>
    </message>
    <message>
        <source>d is at most {0} px: point to read it</source>
        <translation>d ist höchstens {0} px: zum Ablesen zeigen</translation>
    </message>
</context>
<context>
    <name>DividedImages</name>
    <message>
        <source>Image {0} and {1}</source>
        <translation>Bild {0} und {1}</translation>
    </message>
    <message>
        <source>Drag the divider, or move it by the arrow keys. The wheel magnifies (+ and −); drag to look around, double-click or 0 for the whole image.</source>
        <translation>Den Teiler ziehen oder mit den Pfeiltasten bewegen. Das Rad vergrößert (+ und −); ziehen verschiebt, Doppelklick oder 0 zeigt das ganze Bild.</translation>
    </message>
</context>
<context>
    <name>DoneList</name>
    <message>
        <source>What was done</source>
        <translation>Was getan wurde</translation>
    </message>
    <message>
        <source>why</source>
        <translation>warum</translation>
    </message>
    <message>
        <source>Show what speaks for it</source>
        <translation>Zeigen, was dafür spricht</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>Kamera verbessern</translation>
    </message>
    <message>
        <source>Take this step back; redo brings it again</source>
        <translation>Diesen Schritt zurücknehmen; Wiederholen bringt ihn wieder</translation>
    </message>
    <message>
        <source>undo</source>
        <translation>zurück</translation>
    </message>
    <message>
        <source>Lens: the paper&apos;s model; no other predicts better</source>
        <translation>Linse: das Modell des Aufsatzes; kein anderes sagt besser vorher</translation>
    </message>
    <message>
        <source>Lens: {0}, which predicts best</source>
        <translation>Linse: {0}, sagt am besten vorher</translation>
    </message>
    <message>
        <source>{0} of {1} photographs could not be used: {2}</source>
        <translation>{0} von {1} Fotos waren nicht zu gebrauchen: {2}</translation>
    </message>
    <message>
        <source>Show the photograph</source>
        <translation>Das Foto zeigen</translation>
    </message>
</context>
<context>
    <name>ExportDialog</name>
    <message>
        <source>Export</source>
        <translation>Exportieren</translation>
    </message>
    <message>
        <source>Formats</source>
        <translation>Formate</translation>
    </message>
    <message>
        <source>The file&apos;s text</source>
        <translation>Der Text der Datei</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Read by</source>
        <translation>Gelesen von</translation>
    </message>
    <message>
        <source>Keeps</source>
        <translation>Behält</translation>
    </message>
    <message>
        <source>Loses</source>
        <translation>Verliert</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Largest error</source>
        <translation>Größter Fehler</translation>
    </message>
    <message>
        <source>&amp;Copy text</source>
        <translation>Text &amp;kopieren</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Speichern…</translation>
    </message>
    <message>
        <source>Save &amp;all…</source>
        <translation>&amp;Alle speichern…</translation>
    </message>
    <message>
        <source>Every format in a folder, with a page that tells who reads which file</source>
        <translation>Jedes Format in einen Ordner, mit einer Seite, die sagt, wer welche Datei liest</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>rechnet…</translation>
    </message>
    <message>
        <source>Preparing {0}</source>
        <translation>{0} vorbereiten</translation>
    </message>
    <message>
        <source>A binary file of {0:.1f} MB</source>
        <translation>Eine Binärdatei von {0:.1f} MB</translation>
    </message>
    <message>
        <source>none: nothing is refitted</source>
        <translation>keiner: nichts wird neu angepasst</translation>
    </message>
    <message>
        <source>unlimited in parts of the image that no corner covers</source>
        <translation>unbegrenzt in Teilen des Bildes ohne Ecken</translation>
    </message>
    <message>
        <source>{0:.3g} px over the whole image</source>
        <translation>{0:.3g} px über dem ganzen Bild</translation>
    </message>
    <message>
        <source>The text is on the clipboard.</source>
        <translation>Der Text ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>{0} schreiben</translation>
    </message>
    <message>
        <source>Folder for all formats</source>
        <translation>Ordner für alle Formate</translation>
    </message>
    <message>
        <source>Writing all formats</source>
        <translation>Alle Formate schreiben</translation>
    </message>
    <message>
        <source>{0} of {1} formats are in {2}</source>
        <translation>{0} von {1} Formaten sind in {2}</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
</context>
<context>
    <name>Files</name>
    <message>
        <source>Only the project {0} is opened, without the {1} other files.</source>
        <translation>Nur das Projekt {0} wird geöffnet, ohne die {1} anderen Dateien.</translation>
    </message>
    <message>
        <source>Camera file</source>
        <translation>Kameradatei</translation>
    </message>
    <message>
        <source>Camera files (*)</source>
        <translation>Kameradateien (*)</translation>
    </message>
    <message>
        <source>Not added, as no image can be read there: {0}.</source>
        <translation>Nicht hinzugefügt, da dort kein Bild zu lesen ist: {0}.</translation>
    </message>
    <message>
        <source>By their names these are photographs of several cameras: {0}. File › Several cameras calibrates each, and how they stand to each other.</source>
        <translation>Ihren Namen nach sind dies Fotos mehrerer Kameras: {0}. Datei › Mehrere Kameras kalibriert jede, und wie sie zueinander stehen.</translation>
    </message>
    <message>
        <source>Folder of images</source>
        <translation>Ordner mit Bildern</translation>
    </message>
    <message>
        <source>Add images</source>
        <translation>Bilder hinzufügen</translation>
    </message>
    <message>
        <source>Images ({0});;All files, also videos (*)</source>
        <translation>Bilder ({0});;Alle Dateien, auch Videos (*)</translation>
    </message>
    <message>
        <source>Open project</source>
        <translation>Projekt öffnen</translation>
    </message>
    <message>
        <source>Projects (*.json)</source>
        <translation>Projekte (*.json)</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>{0} öffnen</translation>
    </message>
    <message>
        <source>Replace the project</source>
        <translation>Projekt ersetzen</translation>
    </message>
    <message>
        <source>{0} has been saved by another window or program since it was opened here. Replace what is there now?</source>
        <translation>{0} wurde von einem anderen Fenster oder Programm gespeichert, seit es hier geöffnet wurde. Ersetzen, was jetzt dort steht?</translation>
    </message>
    <message>
        <source>Save project</source>
        <translation>Projekt speichern</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>Ungespeicherte Änderungen</translation>
    </message>
    <message>
        <source>Save the changes to this project?</source>
        <translation>Die Änderungen an diesem Projekt speichern?</translation>
    </message>
    <message>
        <source>What you discard is kept for a while in {0}.</source>
        <translation>Was Sie verwerfen, bleibt eine Weile in {0}.</translation>
    </message>
    <message>
        <source>Discard the changes without a copy?</source>
        <translation>Die Änderungen ohne Kopie verwerfen?</translation>
    </message>
    <message>
        <source>Folder that holds the missing images</source>
        <translation>Ordner mit den fehlenden Bildern</translation>
    </message>
    <message>
        <source>Relocate images</source>
        <translation>Bilder neu verorten</translation>
    </message>
    <message>
        <source>Found {0} of {1} missing images in {2}.</source>
        <translation>{0} von {1} fehlenden Bildern in {2} gefunden.</translation>
    </message>
    <message>
        <source>Looking for images</source>
        <translation>Bilder suchen</translation>
    </message>
    <message>
        <source>Rename result</source>
        <translation>Ergebnis umbenennen</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>Delete {0}</source>
        <translation>{0} löschen</translation>
    </message>
    <message>
        <source>Folder for the images</source>
        <translation>Ordner für die Bilder</translation>
    </message>
    <message>
        <source>Writing images</source>
        <translation>Bilder schreiben</translation>
    </message>
    <message>
        <source>Wrote {0} images to {1}.</source>
        <translation>{0} Bilder nach {1} geschrieben.</translation>
    </message>
    <message>
        <source>Wrote {0} image to {1}.</source>
        <translation>{0} Bild nach {1} geschrieben.</translation>
    </message>
    <message>
        <source>Replace files</source>
        <translation>Dateien ersetzen</translation>
    </message>
    <message>
        <source>In {0} there are files of these names, not written by this program:</source>
        <translation>In {0} gibt es Dateien dieser Namen, die nicht von diesem Programm sind:</translation>
    </message>
    <message>
        <source>Replace them?</source>
        <translation>Ersetzen?</translation>
    </message>
</context>
<context>
    <name>FilmStrip</name>
    <message>
        <source>Images</source>
        <translation>Bilder</translation>
    </message>
    <message>
        <source>Leave the images out whose error is above the threshold</source>
        <translation>Die Bilder weglassen, deren Fehler über der Schwelle liegt</translation>
    </message>
    <message>
        <source>Refit at &amp;once</source>
        <translation>&amp;Sofort neu anpassen</translation>
    </message>
    <message>
        <source>Calibrate again at once when images are excluded or included. The shown result is replaced; undo brings it back.</source>
        <translation>Sofort neu kalibrieren, wenn Bilder weggelassen oder wieder genommen werden. Das gezeigte Ergebnis wird ersetzt; Rückgängig bringt es wieder.</translation>
    </message>
    <message>
        <source>Sort by &amp;name</source>
        <translation>Nach &amp;Namen ordnen</translation>
    </message>
    <message>
        <source>Sort by &amp;status</source>
        <translation>Nach &amp;Zustand ordnen</translation>
    </message>
    <message>
        <source>Sort by lar&amp;gest error</source>
        <translation>Nach größtem &amp;Fehler ordnen</translation>
    </message>
    <message>
        <source>Put the images in this order</source>
        <translation>Die Bilder so ordnen</translation>
    </message>
    <message>
        <source>Include {0}</source>
        <translation>{0} wieder nehmen</translation>
    </message>
    <message>
        <source>Exclude {0}</source>
        <translation>{0} weglassen</translation>
    </message>
    <message>
        <source>Remove {0}</source>
        <translation>{0} entfernen</translation>
    </message>
    <message>
        <source>{0} images</source>
        <translation>{0} Bilder</translation>
    </message>
    <message>
        <source>Ex&amp;clude or include</source>
        <translation>&amp;Weglassen oder nehmen</translation>
    </message>
    <message>
        <source>Leave the selected images out of the calibration, or take them in again.</source>
        <translation>Die gewählten Bilder beim Kalibrieren weglassen oder wieder nehmen.</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>&amp;Neu suchen</translation>
    </message>
    <message>
        <source>Forget what was found in the selected images and search them anew.</source>
        <translation>Vergessen, was in den gewählten Bildern gefunden wurde, und neu suchen.</translation>
    </message>
    <message>
        <source>&amp;Remove from project</source>
        <translation>Aus dem Projekt &amp;entfernen</translation>
    </message>
    <message>
        <source>Take the selected images out of the project. The files stay.</source>
        <translation>Die gewählten Bilder aus dem Projekt nehmen. Die Dateien bleiben.</translation>
    </message>
    <message>
        <source>No image is selected in the list.</source>
        <translation>Kein Bild der Liste ist gewählt.</translation>
    </message>
    <message>
        <source>{0} px: {1} above · leave out</source>
        <translation>{0} px: {1} darüber · weglassen</translation>
    </message>
    <message>
        <source>{0} px: all are above</source>
        <translation>{0} px: alle sind darüber</translation>
    </message>
    <message>
        <source>{0} px: none above</source>
        <translation>{0} px: keines darüber</translation>
    </message>
</context>
<context>
    <name>FindingRow</name>
    <message>
        <source>{0} times better once mended</source>
        <translation>behoben {0}-mal besser</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Show the figures and what to do</source>
        <translation>Die Zahlen zeigen, und was zu tun ist</translation>
    </message>
    <message>
        <source>Show the evidence</source>
        <translation>Den Beleg zeigen</translation>
    </message>
</context>
<context>
    <name>FleetDialog</name>
    <message>
        <source>Fleet {0}</source>
        <translation>Flotte {0}</translation>
    </message>
    <message>
        <source>{0} cameras. Failing: {1}. Unlike the others of their image size and lens model: {2}. Changed: {3}.</source>
        <translation>{0} Kameras. Durchgefallen: {1}. Anders als die übrigen ihrer Bildgröße und ihres Linsenmodells: {2}. Verändert: {3}.</translation>
    </message>
    <message>
        <source>Camera, serial number, reason…</source>
        <translation>Kamera, Seriennummer, Grund…</translation>
    </message>
    <message>
        <source>Filter</source>
        <translation>Filter</translation>
    </message>
    <message>
        <source>Which cameras are shown</source>
        <translation>Welche Kameras gezeigt werden</translation>
    </message>
    <message>
        <source>all</source>
        <translation>alle</translation>
    </message>
    <message>
        <source>failing</source>
        <translation>durchgefallen</translation>
    </message>
    <message>
        <source>unlike the others</source>
        <translation>anders als die übrigen</translation>
    </message>
    <message>
        <source>changed</source>
        <translation>verändert</translation>
    </message>
    <message>
        <source>First photograph of the camera</source>
        <translation>Erstes Foto der Kamera</translation>
    </message>
    <message>
        <source>&amp;Open camera</source>
        <translation>Kamera ö&amp;ffnen</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Date</source>
        <translation>Datum</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Urteil</translation>
    </message>
    <message>
        <source>pass</source>
        <translation>bestanden</translation>
    </message>
    <message>
        <source>fail</source>
        <translation>durchgefallen</translation>
    </message>
    <message>
        <source>Whether the camera keeps the limits of its fleet</source>
        <translation>Ob die Kamera die Grenzen ihrer Flotte einhält</translation>
    </message>
    <message>
        <source>Views</source>
        <translation>Ansichten</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Root mean square residual</source>
        <translation>Quadratisch gemitteltes Residuum</translation>
    </message>
    <message>
        <source>Standard deviation of one coordinate of a corner</source>
        <translation>Standardabweichung einer Koordinate einer Ecke</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Ecken</translation>
    </message>
    <message>
        <source>Error, edge</source>
        <translation>Fehler, Rand</translation>
    </message>
    <message>
        <source>Error of a pixel at the image&apos;s edge, one standard deviation</source>
        <translation>Fehler eines Pixels am Bildrand, eine Standardabweichung</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Unterschied</translation>
    </message>
    <message>
        <source>Distance from the median camera of the same image size and lens model, rms over the image, after the rotation that brings both together</source>
        <translation>Abstand von der mittleren Kamera gleicher Bildgröße und gleichen Linsenmodells, RMS über dem Bild, nach der Drehung, die beide zusammenbringt</translation>
    </message>
    <message>
        <source>In σ</source>
        <translation>In σ</translation>
    </message>
    <message>
        <source>The difference in standard deviations of the fleet</source>
        <translation>Der Unterschied in Standardabweichungen der Flotte</translation>
    </message>
    <message>
        <source>Changed by</source>
        <translation>Geändert um</translation>
    </message>
    <message>
        <source>Difference from the last calibration of the serial number</source>
        <translation>Unterschied zur letzten Kalibrierung der Seriennummer</translation>
    </message>
    <message>
        <source>It is unlike the others of its kind.</source>
        <translation>Sie ist anders als die übrigen ihrer Art.</translation>
    </message>
    <message>
        <source>It has changed since {0}, by {1:.2g} px at most.</source>
        <translation>Sie hat sich seit {0} verändert, um höchstens {1:.2g} px.</translation>
    </message>
    <message>
        <source>It passes.</source>
        <translation>Sie besteht.</translation>
    </message>
</context>
<context>
    <name>GlassRow</name>
    <message>
        <source>If the board is of glass, printed true to {0:g} mm and flat to {1:g} mm: {2} px.</source>
        <translation>Wenn das Brett aus Glas ist, auf {0:g} mm maßhaltig gedruckt und auf {1:g} mm eben: {2} px.</translation>
    </message>
    <message>
        <source>It is of glass</source>
        <translation>Es ist aus Glas</translation>
    </message>
</context>
<context>
    <name>GoodSet</name>
    <message>
        <source>filling the image</source>
        <translation>füllt das Bild</translation>
    </message>
    <message>
        <source>tilted back</source>
        <translation>nach hinten geneigt</translation>
    </message>
    <message>
        <source>tilted to a side</source>
        <translation>zur Seite geneigt</translation>
    </message>
    <message>
        <source>in one corner</source>
        <translation>in einer Ecke</translation>
    </message>
    <message>
        <source>in the others</source>
        <translation>in den anderen</translation>
    </message>
    <message>
        <source>turned upright</source>
        <translation>hochkant gedreht</translation>
    </message>
    <message>
        <source>A good set of photographs</source>
        <translation>Ein guter Satz Fotos</translation>
    </message>
    <message>
        <source>10 to 20 of one flat board: sharp, evenly lit, with the focus and zoom that the camera will have at work.</source>
        <translation>10 bis 20 von einem ebenen Brett: scharf, gleichmäßig hell, mit dem Fokus und Zoom, mit dem die Kamera arbeiten wird.</translation>
    </message>
</context>
<context>
    <name>HandEyeDialog</name>
    <message>
        <source>Hand and eye</source>
        <translation>Hand und Auge</translation>
    </message>
    <message>
        <source>Robot&apos;s &amp;poses…</source>
        <translation>Roboter&amp;posen…</translation>
    </message>
    <message>
        <source>CSV, JSON, text or MAT: a pose for each photograph, by its name or in their order, in any units and convention</source>
        <translation>CSV, JSON, Text oder MAT: eine Pose für jedes Foto, nach seinem Namen oder in deren Reihenfolge, in beliebigen Einheiten und Konventionen</translation>
    </message>
    <message>
        <source>Where the camera is</source>
        <translation>Wo die Kamera ist</translation>
    </message>
    <message>
        <source>as the poses tell</source>
        <translation>wie es die Posen sagen</translation>
    </message>
    <message>
        <source>in the hand</source>
        <translation>in der Hand</translation>
    </message>
    <message>
        <source>beside the robot</source>
        <translation>neben dem Roboter</translation>
    </message>
    <message>
        <source>The tool&apos;s point in the hand&apos;s frame</source>
        <translation>Der Punkt des Werkzeugs im System der Hand</translation>
    </message>
    <message>
        <source>X, Y, Z: the board</source>
        <translation>X, Y, Z: das Brett</translation>
    </message>
    <message>
        <source>Where ± is stated, as 0, 0, 120; if empty, it is where the board was</source>
        <translation>Wo ± angegeben wird, etwa 0, 0, 120; wenn leer, dort, wo das Brett war</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Speichern…</translation>
    </message>
    <message>
        <source>Choose the file of the poses at which the robot stood for the photographs.</source>
        <translation>Wählen Sie die Datei mit den Posen, in denen der Roboter für die Fotos stand.</translation>
    </message>
    <message>
        <source>The side of a square is not known, and the robot&apos;s poses have lengths. Close this, and answer in the window how long the squares are.</source>
        <translation>Die Seite eines Quadrats ist nicht bekannt, und die Posen des Roboters haben Längen. Schließen Sie dies und beantworten Sie im Fenster, wie lang die Quadrate sind.</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Tool at</source>
        <translation>Werkzeug bei</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Poses of the robot</source>
        <translation>Posen des Roboters</translation>
    </message>
    <message>
        <source>Poses (*.csv *.json *.txt *.mat);;All files (*)</source>
        <translation>Posen (*.csv *.json *.txt *.mat);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>{0} is no point X, Y, Z, such as 0, 0, 120.</source>
        <translation>{0} ist kein Punkt X, Y, Z wie 0, 0, 120.</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>rechnet…</translation>
    </message>
    <message>
        <source>Finding hand and eye</source>
        <translation>Hand und Auge werden bestimmt</translation>
    </message>
    <message>
        <source>Camera in the hand</source>
        <translation>Kamera in der Hand</translation>
    </message>
    <message>
        <source>Board in the base</source>
        <translation>Brett in der Basis</translation>
    </message>
    <message>
        <source>Camera in the base</source>
        <translation>Kamera in der Basis</translation>
    </message>
    <message>
        <source>Board in the hand</source>
        <translation>Brett in der Hand</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>rotation vector, {0}</source>
        <translation>Drehvektor, {0}</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>degrees</source>
        <translation>Grad</translation>
    </message>
    <message>
        <source>The most likely error of the robot&apos;s pose</source>
        <translation>Der wahrscheinlichste Fehler der Pose des Roboters</translation>
    </message>
    <message>
        <source>Photograph</source>
        <translation>Foto</translation>
    </message>
    <message>
        <source>Robot off by</source>
        <translation>Roboter daneben um</translation>
    </message>
    <message>
        <source>Turned by</source>
        <translation>Verdreht um</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>Benutzt</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>ja</translation>
    </message>
    <message>
        <source>&amp;Use again</source>
        <translation>Wieder &amp;verwenden</translation>
    </message>
    <message>
        <source>&amp;Leave out</source>
        <translation>&amp;Weglassen</translation>
    </message>
    <message>
        <source>Save hand and eye</source>
        <translation>Hand und Auge speichern</translation>
    </message>
    <message>
        <source>Hand and eye (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</source>
        <translation>Hand und Auge (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>{0} schreiben</translation>
    </message>
    <message>
        <source>Saved as {0}.</source>
        <translation>Gespeichert als {0}.</translation>
    </message>
</context>
<context>
    <name>Header</name>
    <message>
        <source>Set-up</source>
        <translation>Einrichtung</translation>
    </message>
    <message>
        <source>The board, the lens, and how to calibrate</source>
        <translation>Das Brett, die Linse und wie kalibriert wird</translation>
    </message>
    <message>
        <source>Report…</source>
        <translation>Bericht…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page (Ctrl+P)</source>
        <translation>Was bekannt ist als PDF oder Webseite schreiben (Strg+P)</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>Export…</translation>
    </message>
    <message>
        <source>Write the camera for another program (Ctrl+E)</source>
        <translation>Die Kamera für ein anderes Programm schreiben (Strg+E)</translation>
    </message>
    <message>
        <source>Show the verdict, or hide it again</source>
        <translation>Das Urteil zeigen oder wieder ausblenden</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Ohne Namen</translation>
    </message>
    <message>
        <source>1 photograph</source>
        <translation>1 Foto</translation>
    </message>
    <message>
        <source>{0} photographs</source>
        <translation>{0} Fotos</translation>
    </message>
    <message>
        <source>{0} of {1} photographs usable</source>
        <translation>{0} von {1} Fotos brauchbar</translation>
    </message>
</context>
<context>
    <name>HistogramPlot</name>
    <message>
        <source>density</source>
        <translation>Dichte</translation>
    </message>
    <message>
        <source>Rayleigh s</source>
        <translation>Rayleigh s</translation>
    </message>
    <message>
        <source>Gaussian σ</source>
        <translation>Gauß σ</translation>
    </message>
    <message>
        <source>mean {0:.4f}, SD {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</source>
        <translation>Mittel {0:.4f}, Std. {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</translation>
    </message>
    <message>
        <source>; {0} farther out</source>
        <translation>; {0} weiter außen</translation>
    </message>
</context>
<context>
    <name>Histograms</name>
    <message>
        <source>Component of the residuals</source>
        <translation>Komponente der Residuen</translation>
    </message>
    <message>
        <source>The residuals&apos; components on the reference plane, or their length e′.</source>
        <translation>Die Komponenten der Residuen auf der Referenzebene, oder ihre Länge e′.</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>Referenz-px</translation>
    </message>
    <message>
        <source>{0}, real</source>
        <translation>{0}, echt</translation>
    </message>
    <message>
        <source>{0}, synthetic</source>
        <translation>{0}, synthetisch</translation>
    </message>
</context>
<context>
    <name>HistogramsPanel</name>
    <message>
        <source>Histograms</source>
        <translation>Histogramme</translation>
    </message>
    <message>
        <source>How the residuals are distributed, beside a Gaussian and a Rayleigh distribution.</source>
        <translation>Wie die Residuen verteilt sind, neben einer Gauß- und einer Rayleigh-Verteilung.</translation>
    </message>
    <message>
        <source>Noise of equal size in all directions has Gaussian components and lengths after Rayleigh.
Heavy tails mean bad corners; two humps, a board that is not flat or a wrong model.</source>
        <translation>Rauschen, das in alle Richtungen gleich ist, hat Gaußsche Komponenten und Längen nach Rayleigh.
Schwere Enden bedeuten schlechte Ecken; zwei Höcker ein unebenes Brett oder ein falsches Modell.</translation>
    </message>
</context>
<context>
    <name>ImageModel</name>
    <message>
        <source>changed · {0}</source>
        <translation>geändert · {0}</translation>
    </message>
    <message>
        <source>{0}, error {1:.3f} px</source>
        <translation>{0}, Fehler {1:.3f} px</translation>
    </message>
    <message>
        <source>The file has changed since its corners were found: detect again.</source>
        <translation>Die Datei hat sich geändert, seit ihre Ecken gefunden wurden: neu suchen.</translation>
    </message>
</context>
<context>
    <name>ImagePage</name>
    <message>
        <source>Tools</source>
        <translation>Werkzeuge</translation>
    </message>
    <message>
        <source>Layers</source>
        <translation>Ebenen</translation>
    </message>
    <message>
        <source>Choose what is drawn over the image</source>
        <translation>Wählen, was über das Bild gezeichnet wird</translation>
    </message>
    <message>
        <source>&amp;Mark board</source>
        <translation>Brett &amp;markieren</translation>
    </message>
    <message>
        <source>Point at the board&apos;s four outermost corners</source>
        <translation>Auf die vier äußersten Ecken des Bretts zeigen</translation>
    </message>
    <message>
        <source>&amp;Edit corners</source>
        <translation>&amp;Ecken bearbeiten</translation>
    </message>
    <message>
        <source>Move, remove and restore single corners; turn the axes</source>
        <translation>Einzelne Ecken verschieben, entfernen und zurückholen; die Achsen drehen</translation>
    </message>
    <message>
        <source>Mark</source>
        <translation>Markieren</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>Ändern</translation>
    </message>
    <message>
        <source>&amp;Fit</source>
        <translation>&amp;Einpassen</translation>
    </message>
    <message>
        <source>Show the whole image</source>
        <translation>Das ganze Bild zeigen</translation>
    </message>
    <message>
        <source>&amp;1:1</source>
        <translation>&amp;1:1</translation>
    </message>
    <message>
        <source>Show the image&apos;s pixels as pixels of the screen</source>
        <translation>Pixel des Bildes als Pixel des Bildschirms zeigen</translation>
    </message>
    <message>
        <source>No image is shown that can be read.</source>
        <translation>Kein lesbares Bild wird gezeigt.</translation>
    </message>
    <message>
        <source>, {0} px</source>
        <translation>, {0} px</translation>
    </message>
    <message>
        <source>corner in row {0}, column {1}: u {2:.3f}, v {3:.3f} px</source>
        <translation>Ecke in Zeile {0}, Spalte {1}: u {2:.3f}, v {3:.3f} px</translation>
    </message>
    <message>
        <source>; residual Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px</source>
        <translation>; Residuum Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px</translation>
    </message>
    <message>
        <source>u {0:.2f}  v {1:.2f} px</source>
        <translation>u {0:.2f}  v {1:.2f} px</translation>
    </message>
    <message>
        <source>   grey {0}</source>
        <translation>   Grau {0}</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its place</source>
        <translation>   Ecke: Zeile {0}, Spalte {1}; klicken zeigt ihren Ort</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its residual</source>
        <translation>   Ecke: Zeile {0}, Spalte {1}; klicken zeigt ihr Residuum</translation>
    </message>
</context>
<context>
    <name>Inspector</name>
    <message>
        <source>Is the camera still good?

Drop new photographs of the board here: they check it and change nothing.

Dropped on the left they join the project.</source>
        <translation>Ist die Kamera noch gut?

Neue Fotos des Bretts hier ablegen: sie prüfen sie und ändern nichts.

Links abgelegt kommen sie ins Projekt.</translation>
    </message>
</context>
<context>
    <name>InstantView</name>
    <message>
        <source>Photographs of an instant</source>
        <translation>Fotos eines Zeitpunkts</translation>
    </message>
</context>
<context>
    <name>KnownCameraChoice</name>
    <message>
        <source>calibrated</source>
        <translation>kalibriert</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>Wählen…</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>Neu kalibrieren</translation>
    </message>
    <message>
        <source>Hold the camera of a file of this or another program, and locate the board in photographs with it. Such a file can also be dropped on the window.</source>
        <translation>Die Kamera aus einer Datei dieses oder eines anderen Programms festhalten und das Brett in Fotos mit ihr verorten. Eine solche Datei lässt sich auch auf dem Fenster ablegen.</translation>
    </message>
    <message>
        <source>Give the camera of the file up: calibrate one from the photographs.</source>
        <translation>Die Kamera der Datei aufgeben: eine aus den Fotos kalibrieren.</translation>
    </message>
</context>
<context>
    <name>KnownCameras</name>
    <message>
        <source>Known camera</source>
        <translation>Bekannte Kamera</translation>
    </message>
    <message>
        <source>The camera of {0} ({1}) stays as it is: Calibrate only finds where the board was. To calibrate another, take it away in the Set-up.</source>
        <translation>Die Kamera aus {0} ({1}) bleibt, wie sie ist: Kalibrieren findet nur, wo das Brett war. Um eine andere zu kalibrieren, sie in der Einrichtung entfernen.</translation>
    </message>
    <message>
        <source>Of {0} camera files it is the first.</source>
        <translation>Von {0} Kameradateien ist es die erste.</translation>
    </message>
</context>
<context>
    <name>LayerMenu</name>
    <message>
        <source>Residuals × </source>
        <translation>Residuen × </translation>
    </message>
    <message>
        <source>How many times as long as they are residuals are drawn</source>
        <translation>Wievielmal so lang wie sie sind Residuen gezeichnet werden</translation>
    </message>
    <message>
        <source>Magnification of residuals</source>
        <translation>Vergrößerung der Residuen</translation>
    </message>
    <message>
        <source>&amp;Region of interest</source>
        <translation>Such&amp;bereich</translation>
    </message>
    <message>
        <source>The part of the image that was searched (yellow outline)</source>
        <translation>Der Teil des Bildes, der abgesucht wurde (gelber Umriss)</translation>
    </message>
    <message>
        <source>First &amp;estimates</source>
        <translation>Erste &amp;Schätzungen</translation>
    </message>
    <message>
        <source>Corners to the nearest pixel, by Harris&apos; detector (red +)</source>
        <translation>Ecken auf das nächste Pixel, nach Harris (rotes +)</translation>
    </message>
    <message>
        <source>Refi&amp;ned corners</source>
        <translation>&amp;Verfeinerte Ecken</translation>
    </message>
    <message>
        <source>Corners at the saddle point of the grey levels (yellow +)</source>
        <translation>Ecken am Sattelpunkt der Grauwerte (gelbes +)</translation>
    </message>
    <message>
        <source>&amp;Order and axes</source>
        <translation>&amp;Ordnung und Achsen</translation>
    </message>
    <message>
        <source>The numbering of the corners: origin, rows, and the board&apos;s axes</source>
        <translation>Die Zählung der Ecken: Ursprung, Zeilen und die Achsen des Bretts</translation>
    </message>
    <message>
        <source>Re&amp;projection</source>
        <translation>&amp;Rückprojektion</translation>
    </message>
    <message>
        <source>Where the calibration expects the corners (blue circles)</source>
        <translation>Wo die Kalibrierung die Ecken erwartet (blaue Kreise)</translation>
    </message>
    <message>
        <source>Re&amp;siduals</source>
        <translation>R&amp;esiduen</translation>
    </message>
    <message>
        <source>Arrows from expected to measured corners, magnified</source>
        <translation>Pfeile von erwarteten zu gemessenen Ecken, vergrößert</translation>
    </message>
</context>
<context>
    <name>LensModelsPanel</name>
    <message>
        <source>Lens models</source>
        <translation>Linsenmodelle</translation>
    </message>
    <message>
        <source>All lens models on the same corners, by what they predict of unseen views.</source>
        <translation>Alle Linsenmodelle an denselben Ecken, nach dem, was sie von ungesehenen Ansichten vorhersagen.</translation>
    </message>
    <message>
        <source>C&amp;ompare lens models</source>
        <translation>Linsenmodelle &amp;vergleichen</translation>
    </message>
    <message>
        <source>Calibrates every lens model from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>Kalibriert jedes Linsenmodell aus diesen Ansichten, und noch einmal ohne einige davon, um zu sehen, wie gut es Ungesehenes vorhersagt. Dauert eine Weile.</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>Linsenmodelle vergleichen</translation>
    </message>
    <message>
        <source>Calibrating every lens model several times…</source>
        <translation>Jedes Linsenmodell wird mehrmals kalibriert…</translation>
    </message>
    <message>
        <source>&amp;Use this model</source>
        <translation>Dieses &amp;Modell nehmen</translation>
    </message>
    <message>
        <source>Set the selected lens model in the Set-up and calibrate.</source>
        <translation>Das gewählte Linsenmodell in der Einrichtung setzen und kalibrieren.</translation>
    </message>
    <message>
        <source>The views do not determine the camera: lens models cannot be compared on them.</source>
        <translation>Die Ansichten bestimmen die Kamera nicht: Linsenmodelle lassen sich an ihnen nicht vergleichen.</translation>
    </message>
    <message>
        <source>This result is of the lens model {0}. Does another one do better?</source>
        <translation>Dieses Ergebnis ist vom Linsenmodell {0}. Ist ein anderes besser?</translation>
    </message>
    <message>
        <source>{0} cannot be calibrated: {1}</source>
        <translation>{0} lässt sich nicht kalibrieren: {1}</translation>
    </message>
    <message>
        <source>{0}: RMS {1:.3f} px, σx {2:.3f} px and σy {3:.3f} px of {4}.</source>
        <translation>{0}: RMS {1:.3f} px, σx {2:.3f} px und σy {3:.3f} px von {4}.</translation>
    </message>
</context>
<context>
    <name>LensTables</name>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Image</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>n</source>
        <translation>n</translation>
    </message>
    <message>
        <source>Estimated parameters</source>
        <translation>Geschätzte Parameter</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>Residuen einer Kalibrierung aus allen Ansichten</translation>
    </message>
    <message>
        <source>σx</source>
        <translation>σx</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals across the image</source>
        <translation>Standardabweichung dieser Residuen quer über das Bild</translation>
    </message>
    <message>
        <source>σy</source>
        <translation>σy</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals down the image</source>
        <translation>Standardabweichung dieser Residuen von oben nach unten</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>Ungesehen</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>RMS der Residuen von Ansichten, die reihum weggelassen wurden,
nur ihre Lagen angepasst</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>Median</translation>
    </message>
    <message>
        <source>Median length of the residuals of unseen views</source>
        <translation>Mittlere Länge der Residuen ungesehener Ansichten</translation>
    </message>
    <message>
        <source>95 %</source>
        <translation>95 %</translation>
    </message>
    <message>
        <source>Length that 95 % of the residuals of unseen views do not exceed</source>
        <translation>Länge, die 95 % der Residuen ungesehener Ansichten nicht überschreiten</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Bemerkungen</translation>
    </message>
    <message>
        <source>Horizontal</source>
        <translation>Horizontal</translation>
    </message>
    <message>
        <source>H</source>
        <translation>H</translation>
    </message>
    <message>
        <source>Vertical</source>
        <translation>Vertikal</translation>
    </message>
    <message>
        <source>V</source>
        <translation>V</translation>
    </message>
    <message>
        <source>Diagonal</source>
        <translation>Diagonal</translation>
    </message>
    <message>
        <source>D</source>
        <translation>D</translation>
    </message>
    <message>
        <source>Field of view, {0}, degrees</source>
        <translation>Bildwinkel, {0}, Grad</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Ecken</translation>
    </message>
    <message>
        <source>Largest angle off the axis at which a corner was seen, degrees</source>
        <translation>Größter Winkel zur Achse, unter dem eine Ecke gesehen wurde, Grad</translation>
    </message>
    <message>
        <source>BIC</source>
        <translation>BIC</translation>
    </message>
    <message>
        <source>Bayesian information criterion, less the least one</source>
        <translation>Bayessches Informationskriterium, minus das kleinste</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>Anders um</translation>
    </message>
    <message>
        <source>Largest distance from the recommended model&apos;s map where corners were seen</source>
        <translation>Größter Abstand von der Abbildung des empfohlenen Modells, wo Ecken gesehen wurden</translation>
    </message>
    <message>
        <source>Valid</source>
        <translation>Gültig</translation>
    </message>
    <message>
        <source>Part of the image on which the map is one-to-one</source>
        <translation>Teil des Bildes, auf dem die Abbildung eindeutig ist</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>Linsenmodell</translation>
    </message>
</context>
<context>
    <name>LimitsChoice</name>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>What a calibration has to keep, as for a fleet: the verdict stays as it is.</source>
        <translation>Was eine Kalibrierung einhalten muss, wie bei einer Flotte: das Urteil bleibt, wie es ist.</translation>
    </message>
    <message>
        <source>nothing is demanded</source>
        <translation>nichts ist gefordert</translation>
    </message>
    <message>
        <source>from a file…</source>
        <translation>aus einer Datei…</translation>
    </message>
    <message>
        <source>With limits the verdict says PASS or FAIL, as for a fleet&apos;s cameras.</source>
        <translation>Mit Grenzen sagt das Urteil PASS oder FAIL, wie bei den Kameras einer Flotte.</translation>
    </message>
    <message>
        <source>Limits (*.toml)</source>
        <translation>Grenzen (*.toml)</translation>
    </message>
    <message>
        <source>error of a pixel at the edge: at most {0:g} px</source>
        <translation>Fehler eines Pixels am Rand: höchstens {0:g} px</translation>
    </message>
    <message>
        <source>photographs: at least {0:g}</source>
        <translation>Fotos: mindestens {0:g}</translation>
    </message>
    <message>
        <source>of the sensor with corners: at least {0:g} %</source>
        <translation>vom Sensor mit Ecken: mindestens {0:g} %</translation>
    </message>
    <message>
        <source>lengths of {0:g} mm at {1:g} mm: ± {2:g} mm at most</source>
        <translation>Längen von {0:g} mm in {1:g} mm: höchstens ± {2:g} mm</translation>
    </message>
</context>
<context>
    <name>LimitsRow</name>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>FAIL by the limits {0}. {1}</source>
        <translation>FAIL nach den Grenzen {0}. {1}</translation>
    </message>
    <message>
        <source>PASS by the limits {0}.</source>
        <translation>PASS nach den Grenzen {0}.</translation>
    </message>
</context>
<context>
    <name>LivePage</name>
    <message>
        <source>Choose a camera, and press Start.</source>
        <translation>Eine Kamera wählen und auf Start drücken.</translation>
    </message>
    <message>
        <source>as the camera has it</source>
        <translation>wie die Kamera sie hat</translation>
    </message>
    <message>
        <source>{0} × {1} px</source>
        <translation>{0} × {1} px</translation>
    </message>
    <message>
        <source>Exposure, the same in all pictures</source>
        <translation>Belichtung, in allen Bildern dieselbe</translation>
    </message>
    <message>
        <source>Focus, the same in all pictures</source>
        <translation>Fokus, in allen Bildern derselbe</translation>
    </message>
    <message>
        <source>{0}, in the camera&apos;s own unit, of a camera at this computer</source>
        <translation>{0}, in der Einheit der Kamera, bei einer Kamera an diesem Rechner</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>It ends when the camera puts no pixel farther off, one standard deviation</source>
        <translation>Es endet, wenn die Kamera kein Pixel weiter danebensetzt, eine Standardabweichung</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>Wählen…</translation>
    </message>
    <message>
        <source>A &amp;sound for each picture</source>
        <translation>Ein &amp;Ton für jedes Bild</translation>
    </message>
    <message>
        <source>&amp;Start</source>
        <translation>&amp;Start</translation>
    </message>
    <message>
        <source>&amp;Take it now (space)</source>
        <translation>&amp;Jetzt aufnehmen (Leertaste)</translation>
    </message>
    <message>
        <source>&amp;Finish</source>
        <translation>&amp;Beenden</translation>
    </message>
    <message>
        <source>&amp;Calibrate with these</source>
        <translation>Damit &amp;kalibrieren</translation>
    </message>
    <message>
        <source>&amp;Go on</source>
        <translation>&amp;Weiter</translation>
    </message>
    <message>
        <source>&amp;Leave</source>
        <translation>&amp;Verlassen</translation>
    </message>
    <message>
        <source>%p % of the way to the yellow place</source>
        <translation>%p % des Wegs zum gelben Ort</translation>
    </message>
    <message>
        <source>as it is</source>
        <translation>unverändert</translation>
    </message>
    <message>
        <source>Camera, address or folder</source>
        <translation>Kamera, Adresse oder Ordner</translation>
    </message>
    <message>
        <source>Size of its images</source>
        <translation>Größe ihrer Bilder</translation>
    </message>
    <message>
        <source>Exposure</source>
        <translation>Belichtung</translation>
    </message>
    <message>
        <source>Focus</source>
        <translation>Fokus</translation>
    </message>
    <message>
        <source>Until the worst pixel is known to</source>
        <translation>Bis das schlechteste Pixel bekannt ist auf</translation>
    </message>
    <message>
        <source>Pictures are written to</source>
        <translation>Bilder kommen nach</translation>
    </message>
    <message>
        <source>Hold the whole board in the picture: its kind and size are found. The yellow shape shows where it is wanted next. When it is still, sharp and worth it, the picture is taken by itself; every fifth one is put aside to check the camera with. No board at hand? Calibration › Print a board shows one on a screen.</source>
        <translation>Das ganze Brett ins Bild halten: Art und Größe werden gefunden. Die gelbe Form zeigt, wohin es als Nächstes soll. Ist es ruhig, scharf und lohnend, wird das Bild von selbst aufgenommen; jedes fünfte wird zurückgelegt, um die Kamera damit zu prüfen. Kein Brett zur Hand? Kalibrierung › Brett drucken zeigt eines auf einem Bildschirm.</translation>
    </message>
    <message>
        <source>Photograph live</source>
        <translation>Live fotografieren</translation>
    </message>
    <message>
        <source>Opening…</source>
        <translation>Öffnet…</translation>
    </message>
    <message>
        <source>Pictures put aside are predicted to {0} px rms ({1} corners).</source>
        <translation>Zurückgelegte Bilder werden auf {0} px RMS vorhergesagt ({1} Ecken).</translation>
    </message>
    <message>
        <source>Nothing was taken.</source>
        <translation>Nichts wurde aufgenommen.</translation>
    </message>
    <message>
        <source>Done: known well enough.</source>
        <translation>Fertig: gut genug bekannt.</translation>
    </message>
    <message>
        <source>Stopped. More pictures would help.</source>
        <translation>Angehalten. Mehr Bilder würden helfen.</translation>
    </message>
    <message>
        <source>Folder for the pictures</source>
        <translation>Ordner für die Bilder</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Live image</source>
        <translation>Live-Bild</translation>
    </message>
</context>
<context>
    <name>LiveViews</name>
    <message>
        <source>Live image</source>
        <translation type="unfinished">Live-Bild</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>C&amp;alibrate</source>
        <translation>K&amp;alibrieren</translation>
    </message>
    <message>
        <source>Find the corners still missing, then estimate the camera</source>
        <translation>Fehlende Ecken finden, dann die Kamera schätzen</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>Einrichtung</translation>
    </message>
    <message>
        <source>The program has met an error again: {0}.</source>
        <translation>Das Programm ist wieder auf einen Fehler gestoßen: {0}.</translation>
    </message>
    <message>
        <source>Save the project, and start the program anew.</source>
        <translation>Das Projekt speichern und das Programm neu starten.</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Ohne Namen</translation>
    </message>
</context>
<context>
    <name>ManualDialog</name>
    <message>
        <source>Manual</source>
        <translation>Handbuch</translation>
    </message>
    <message>
        <source>Chapters</source>
        <translation>Kapitel</translation>
    </message>
    <message>
        <source>Chapter</source>
        <translation>Kapitel</translation>
    </message>
    <message>
        <source>Open in the &amp;browser</source>
        <translation>Im &amp;Browser öffnen</translation>
    </message>
    <message>
        <source>All chapters as one page, to search and to print</source>
        <translation>Alle Kapitel als eine Seite, zum Suchen und Drucken</translation>
    </message>
</context>
<context>
    <name>ManyCameras</name>
    <message>
        <source>Open fleet</source>
        <translation>Flotte öffnen</translation>
    </message>
    <message>
        <source>Fleets (*.db)</source>
        <translation>Flotten (*.db)</translation>
    </message>
    <message>
        <source>Reading {0}</source>
        <translation>{0} lesen</translation>
    </message>
</context>
<context>
    <name>Marker</name>
    <message>
        <source>Turn axes</source>
        <translation>Achsen drehen</translation>
    </message>
    <message>
        <source>Flip axes</source>
        <translation>Achsen spiegeln</translation>
    </message>
    <message>
        <source>Click the four outermost {1}, going round the board: {0} of 4.</source>
        <translation>Die vier äußersten {1} anklicken, rund um das Brett: {0} von 4.</translation>
    </message>
    <message>
        <source> Backspace takes one back.</source>
        <translation> Rücktaste nimmt eine zurück.</translation>
    </message>
    <message>
        <source>Counting…</source>
        <translation>Zählen…</translation>
    </message>
    <message>
        <source>{0} of {1} corners. Enter accepts; drag a handle to change them.</source>
        <translation>{0} von {1} Ecken. Enter nimmt sie; Griffe lassen sich ziehen.</translation>
    </message>
    <message>
        <source> The other images show {0} × {1}.</source>
        <translation> Die anderen Bilder zeigen {0} × {1}.</translation>
    </message>
    <message>
        <source>This image has {0} × {1} pixels, the others {2} × {3}.</source>
        <translation>Dieses Bild hat {0} × {1} Pixel, die anderen {2} × {3}.</translation>
    </message>
    <message>
        <source>Calibrate images of each size by themselves.</source>
        <translation>Bilder jeder Größe für sich kalibrieren.</translation>
    </message>
    <message>
        <source>Mark board</source>
        <translation>Brett markieren</translation>
    </message>
    <message>
        <source>Move corner</source>
        <translation>Ecke verschieben</translation>
    </message>
    <message>
        <source>Remove corner</source>
        <translation>Ecke entfernen</translation>
    </message>
    <message>
        <source>Restore corner</source>
        <translation>Ecke zurückholen</translation>
    </message>
</context>
<context>
    <name>Matrix</name>
    <message>
        <source>correlation of {0} and {1}: {2:+.4f}</source>
        <translation>Korrelation von {0} und {1}: {2:+.4f}</translation>
    </message>
</context>
<context>
    <name>MethodChoice</name>
    <message>
        <source>Method</source>
        <translation>Verfahren</translation>
    </message>
</context>
<context>
    <name>MethodTables</name>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>It knows no lengths: this is the distance of corners from straight rows and columns.
Compare it with methods marked * only.</source>
        <translation>Es kennt keine Längen: dies ist der Abstand der Ecken von geraden Zeilen und Spalten.
Nur mit Verfahren vergleichen, die * tragen.</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>Residuen einer Kalibrierung aus allen Ansichten</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate of these residuals</source>
        <translation>Standardabweichung einer Koordinate dieser Residuen</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>Ungesehen</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>RMS der Residuen von Ansichten, die reihum weggelassen wurden,
nur ihre Lagen angepasst</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>Anders um</translation>
    </message>
    <message>
        <source>Largest distance between a point&apos;s images by this method and by the chosen
calibration, where corners were seen</source>
        <translation>Größter Abstand der Bilder eines Punktes nach diesem Verfahren und nach der gewählten
Kalibrierung, wo Ecken gesehen wurden</translation>
    </message>
    <message>
        <source>in RMS</source>
        <translation>als RMS</translation>
    </message>
    <message>
        <source>Root mean square of these distances</source>
        <translation>Quadratisches Mittel dieser Abstände</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Iterations of the refinement; a dash where there are none, or not told</source>
        <translation>Iterationen der Verfeinerung; ein Strich, wo es keine gibt oder sie nicht genannt sind</translation>
    </message>
    <message>
        <source>Time [s]</source>
        <translation>Zeit [s]</translation>
    </message>
    <message>
        <source>Time of initialisation and refinement from all views</source>
        <translation>Zeit für Anfang und Verfeinerung aus allen Ansichten</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Bemerkungen</translation>
    </message>
    <message>
        <source>Principal point; of methods marked * the distortion&apos;s centre</source>
        <translation>Bildhauptpunkt; bei Verfahren mit * die Mitte der Verzeichnung</translation>
    </message>
    <message>
        <source>Focal length across the image</source>
        <translation>Brennweite quer über das Bild</translation>
    </message>
    <message>
        <source>Focal length down the image</source>
        <translation>Brennweite von oben nach unten</translation>
    </message>
    <message>
        <source>Shift across the image over a length of fy down it</source>
        <translation>Verschiebung quer über eine Länge von fy nach unten</translation>
    </message>
    <message>
        <source>How far the distortion moves points that are measured {0:.0f} px from the centre,
where the outermost corner lies; negative towards it</source>
        <translation>Wie weit die Verzeichnung Punkte verschiebt, die {0:.0f} px von der Mitte gemessen sind,
wo die äußerste Ecke liegt; negativ zur Mitte hin</translation>
    </message>
    <message>
        <source>Shift</source>
        <translation>Versatz</translation>
    </message>
    <message>
        <source>Coefficients</source>
        <translation>Koeffizienten</translation>
    </message>
    <message>
        <source>{0} ± {1:.2g} px (1σ)</source>
        <translation>{0} ± {1:.2g} px (1σ)</translation>
    </message>
    <message>
        <source>It does not estimate this. {0}</source>
        <translation>Es schätzt das nicht. {0}</translation>
    </message>
    <message>
        <source>One standard deviation of {0}</source>
        <translation>Eine Standardabweichung von {0}</translation>
    </message>
    <message>
        <source>σ of {0}</source>
        <translation>σ von {0}</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Verfahren</translation>
    </message>
</context>
<context>
    <name>MethodsPanel</name>
    <message>
        <source>Methods</source>
        <translation>Verfahren</translation>
    </message>
    <message>
        <source>All methods of calibration on the same corners.</source>
        <translation>Alle Kalibrierverfahren an denselben Ecken.</translation>
    </message>
    <message>
        <source>C&amp;ompare methods</source>
        <translation>Verfahren &amp;vergleichen</translation>
    </message>
    <message>
        <source>Calibrates with every method from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>Kalibriert mit jedem Verfahren aus diesen Ansichten, und noch einmal ohne einige davon, um zu sehen, wie gut es Ungesehenes vorhersagt. Dauert eine Weile.</translation>
    </message>
    <message>
        <source>Comparing methods</source>
        <translation>Verfahren vergleichen</translation>
    </message>
    <message>
        <source>Calibrating with every method several times…</source>
        <translation>Mit jedem Verfahren wird mehrmals kalibriert…</translation>
    </message>
    <message>
        <source>&amp;Use this method</source>
        <translation>Dieses Verfahren &amp;nehmen</translation>
    </message>
    <message>
        <source>About the method</source>
        <translation>Über das Verfahren</translation>
    </message>
    <message>
        <source>Map</source>
        <translation>Karte</translation>
    </message>
    <message>
        <source>About</source>
        <translation>Über</translation>
    </message>
    <message>
        <source>The views do not determine the camera: methods cannot be compared on them.</source>
        <translation>Die Ansichten bestimmen die Kamera nicht: Verfahren lassen sich an ihnen nicht vergleichen.</translation>
    </message>
    <message>
        <source>This result is by the method “{0}”. What would others make of it?</source>
        <translation>Dieses Ergebnis ist vom Verfahren „{0}“. Was machten andere daraus?</translation>
    </message>
    <message>
        <source>Each RMS and σ is of {0:,} corners in {1} views.</source>
        <translation>Jedes RMS und σ ist von {0:,} Ecken in {1} Aufnahmen.</translation>
    </message>
    <message>
        <source>Differences are from the calibration that was shown when they were found.</source>
        <translation>Unterschiede sind zu der Kalibrierung, die gezeigt wurde, als sie gefunden wurden.</translation>
    </message>
    <message>
        <source>Set the selected method in the Set-up and calibrate.</source>
        <translation>Das gewählte Verfahren in der Einrichtung setzen und kalibrieren.</translation>
    </message>
    <message>
        <source>It gives no camera from these views: {0}</source>
        <translation>Es gibt aus diesen Ansichten keine Kamera: {0}</translation>
    </message>
    <message>
        <source>It knows no lengths, and so gives no camera: only the distortion.</source>
        <translation>Es kennt keine Längen und gibt daher keine Kamera: nur die Verzeichnung.</translation>
    </message>
    <message>
        <source>Its coefficients: {0}.</source>
        <translation>Seine Koeffizienten: {0}.</translation>
    </message>
    <message>
        <source>Source: {0}</source>
        <translation>Quelle: {0}</translation>
    </message>
</context>
<context>
    <name>ModeBar</name>
    <message>
        <source>What the desk shows</source>
        <translation>Was der Tisch zeigt</translation>
    </message>
</context>
<context>
    <name>Offers</name>
    <message>
        <source>&amp;All {0} images</source>
        <translation>&amp;Alle {0} Bilder</translation>
    </message>
    <message>
        <source>A report tells how a camera was calibrated, and this one is known from a file. Calibrate it from these photographs?</source>
        <translation>Ein Bericht sagt, wie eine Kamera kalibriert wurde, und diese ist aus einer Datei bekannt. Aus diesen Fotos kalibrieren?</translation>
    </message>
    <message>
        <source>C&amp;alibrate it</source>
        <translation>K&amp;alibrieren</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation type="unfinished">Neu kalibrieren</translation>
    </message>
    <message>
        <source>Open {0}</source>
        <translation>{0} öffnen</translation>
    </message>
    <message>
        <source>The program ended without saving {0}. Its state of {1} has been kept. The project was saved {2}.</source>
        <translation>Das Programm endete, ohne {0} zu speichern. Sein Stand von {1} ist aufgehoben. Das Projekt wurde {2} gespeichert.</translation>
    </message>
    <message>
        <source>The program ended without saving a project of {0} photographs in {1}, which had no name yet. Its state of {2} has been kept.</source>
        <translation>Das Programm endete, ohne ein Projekt mit {0} Fotos in {1} zu speichern, das noch keinen Namen hatte. Sein Stand von {2} ist aufgehoben.</translation>
    </message>
    <message>
        <source>The program ended without saving a project that had no name yet. Its state of {0} has been kept.</source>
        <translation>Das Programm endete, ohne ein Projekt zu speichern, das noch keinen Namen hatte. Sein Stand von {0} ist aufgehoben.</translation>
    </message>
    <message>
        <source>&amp;Recover</source>
        <translation>&amp;Wiederherstellen</translation>
    </message>
    <message>
        <source>Go on &amp;without</source>
        <translation>&amp;Ohne weitermachen</translation>
    </message>
    <message>
        <source>The unsaved state is kept for a while, as {0}.</source>
        <translation>Der ungespeicherte Stand bleibt eine Weile, als {0}.</translation>
    </message>
    <message>
        <source>&amp;Bring it back</source>
        <translation>&amp;Zurückholen</translation>
    </message>
    <message>
        <source>{0} of {1} images changed since their corners were found, among them {2}.</source>
        <translation>{0} von {1} Bildern haben sich geändert, seit ihre Ecken gefunden wurden, darunter {2}.</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>&amp;Neu suchen</translation>
    </message>
    <message>
        <source>{0} of {1} images are not where they were, among them {2}.</source>
        <translation>{0} von {1} Bildern sind nicht, wo sie waren, darunter {2}.</translation>
    </message>
    <message>
        <source>{0} of {1} images are at addresses, among them {2}. Download them, and locate the copies.</source>
        <translation>{0} von {1} Bildern sind im Netz, darunter {2}. Herunterladen und die Kopien suchen.</translation>
    </message>
    <message>
        <source>&amp;Locate…</source>
        <translation>&amp;Suchen…</translation>
    </message>
    <message>
        <source>Looking for another kind of board</source>
        <translation>Eine andere Art Brett suchen</translation>
    </message>
    <message>
        <source>The photographs are mirrored, so that the marks on the board cannot be read. Turn mirroring off in the camera or in its program, and take them again.</source>
        <translation>Die Fotos sind gespiegelt, so dass die Marken auf dem Brett nicht lesbar sind. Das Spiegeln in der Kamera oder ihrem Programm ausschalten und neu fotografieren.</translation>
    </message>
    <message>
        <source>A board of {0} × {1} inner corners is in no image; the images show {2} × {3}.</source>
        <translation>Ein Brett mit {0} × {1} inneren Ecken ist in keinem Bild; die Bilder zeigen {2} × {3}.</translation>
    </message>
    <message>
        <source>&amp;Search for {0} × {1}</source>
        <translation>Nach {0} × {1} &amp;suchen</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Zahl der Ecken</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>Muster</translation>
    </message>
</context>
<context>
    <name>OnDemandPanel</name>
    <message>
        <source>What was found</source>
        <translation>Was gefunden wurde</translation>
    </message>
</context>
<context>
    <name>OwnPages</name>
    <message>
        <source>Several cameras</source>
        <translation type="unfinished">Mehrere Kameras</translation>
    </message>
    <message>
        <source>Are these the photographs of several cameras that stand fast to each other, a folder or a video for each? No: all are of one camera.</source>
        <translation>Sind das Fotos mehrerer Kameras, die fest zueinander stehen, je Kamera ein Ordner oder ein Video? Nein: Alle sind von einer Kamera.</translation>
    </message>
</context>
<context>
    <name>PairingMatrix</name>
    <message>
        <source>Photographs by cameras and instants</source>
        <translation>Fotos nach Kameras und Zeitpunkten</translation>
    </message>
    <message>
        <source>A column for each camera, a row for each instant. Click a camera&apos;s name to choose all its photographs.</source>
        <translation>Eine Spalte je Kamera, eine Zeile je Zeitpunkt. Den Namen einer Kamera anklicken wählt alle ihre Fotos.</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>{0}: contradicts the others</source>
        <translation>{0}: widerspricht den anderen</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>{0}: {1} corners, {2} px rms; alone {3} px</source>
        <translation>{0}: {1} Ecken, {2} px RMS; allein {3} px</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>kein Brett</translation>
    </message>
</context>
<context>
    <name>PairingPane</name>
    <message>
        <source>Earli&amp;er</source>
        <translation type="unfinished">&amp;Früher</translation>
    </message>
    <message>
        <source>La&amp;ter</source>
        <translation type="unfinished">&amp;Später</translation>
    </message>
    <message>
        <source>Lea&amp;ve out</source>
        <translation type="unfinished">&amp;Weglassen</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation type="unfinished">&amp;Rückgängig</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant before</source>
        <translation type="unfinished">Die gewählten Fotos einer Kamera zum vorigen Zeitpunkt schieben</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant after</source>
        <translation type="unfinished">Die gewählten Fotos einer Kamera zum nächsten Zeitpunkt schieben</translation>
    </message>
</context>
<context>
    <name>Palette</name>
    <message>
        <source>Find an action</source>
        <translation>Befehl finden</translation>
    </message>
    <message>
        <source>Type a part of what you want to do</source>
        <translation>Einen Teil dessen tippen, was Sie tun wollen</translation>
    </message>
    <message>
        <source>Part of an action&apos;s name</source>
        <translation>Teil des Namens eines Befehls</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Actions</source>
        <translation>Befehle</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>Befehl</translation>
    </message>
    <message>
        <source>Menu</source>
        <translation>Menü</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Tasten</translation>
    </message>
    <message>
        <source>No action of the menus is called so.</source>
        <translation>So heißt kein Befehl der Menüs.</translation>
    </message>
</context>
<context>
    <name>Panel</name>
    <message>
        <source>Nothing is calibrated yet. What Calibrate finds is shown here.</source>
        <translation>Noch ist nichts kalibriert. Was Kalibrieren findet, steht hier.</translation>
    </message>
</context>
<context>
    <name>ParameterTable</name>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Real</source>
        <translation>Echt</translation>
    </message>
    <message>
        <source>Synthetic</source>
        <translation>Synthetisch</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Unterschied</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>in σ</translation>
    </message>
    <message>
        <source>The difference over the synthetic result&apos;s standard deviation.</source>
        <translation>Der Unterschied, geteilt durch die Standardabweichung des synthetischen Ergebnisses.</translation>
    </message>
</context>
<context>
    <name>PatternChoice</name>
    <message>
        <source>Pattern</source>
        <translation>Muster</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>Was auf das Brett gedruckt ist.</translation>
    </message>
    <message>
        <source>The set of markers on the board, by OpenCV&apos;s name.</source>
        <translation>Der Satz der Marken auf dem Brett, nach OpenCVs Namen.</translation>
    </message>
    <message>
        <source>Boards with an even number of rows of squares changed with OpenCV 4.6.</source>
        <translation>Bretter mit gerader Zahl von Quadratzeilen änderten sich mit OpenCV 4.6.</translation>
    </message>
    <message>
        <source>first square dark</source>
        <translation>erstes Quadrat dunkel</translation>
    </message>
    <message>
        <source>as before OpenCV 4.6</source>
        <translation>wie vor OpenCV 4.6</translation>
    </message>
    <message>
        <source>A table (CSV) of the circles&apos; x and y in mm, or the same as JSON.</source>
        <translation>Eine Tabelle (CSV) mit x und y der Kreise in mm, oder dasselbe als JSON.</translation>
    </message>
    <message>
        <source>The family of the AprilTags on the board.</source>
        <translation>Die Familie der AprilTags auf dem Brett.</translation>
    </message>
    <message>
        <source>The gap between tags over the side of a tag, at most 1: Kalibr&apos;s tagSpacing.</source>
        <translation>Die Lücke zwischen Marken geteilt durch die Seite einer Marke, höchstens 1: Kalibrs tagSpacing.</translation>
    </message>
    <message>
        <source>The width of a tag&apos;s black border; 2 cells on Kalibr&apos;s.</source>
        <translation>Die Breite des schwarzen Rands einer Marke; 2 Zellen bei Kalibr.</translation>
    </message>
    <message>
        <source>2 cells</source>
        <translation>2 Zellen</translation>
    </message>
    <message>
        <source>1 cell</source>
        <translation>1 Zelle</translation>
    </message>
    <message>
        <source>The row of tags that holds the lowest numbers.</source>
        <translation>Die Zeile der Marken mit den kleinsten Nummern.</translation>
    </message>
    <message>
        <source>from the bottom, as Kalibr</source>
        <translation>von unten, wie Kalibr</translation>
    </message>
    <message>
        <source>from the top</source>
        <translation>von oben</translation>
    </message>
    <message>
        <source>Small dark squares between the corners of the tags, as on Kalibr&apos;s.</source>
        <translation>Kleine dunkle Quadrate zwischen den Ecken der Marken, wie bei Kalibr.</translation>
    </message>
    <message>
        <source>between the tags</source>
        <translation>zwischen den Marken</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>The number of squares from one tag to the next in its row.</source>
        <translation>Die Zahl der Quadrate von einer Marke zur nächsten in ihrer Zeile.</translation>
    </message>
    <message>
        <source>Row of the first corner</source>
        <translation>Zeile der ersten Ecke</translation>
    </message>
    <message>
        <source>Column of the first corner</source>
        <translation>Spalte der ersten Ecke</translation>
    </message>
    <message>
        <source>Row and column of the board&apos;s first corner on the whole PuzzleBoard pattern.</source>
        <translation>Zeile und Spalte der ersten Ecke des Bretts im ganzen PuzzleBoard-Muster.</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>Innere Ecken</translation>
    </message>
    <message>
        <source>Small squares</source>
        <translation>Kleine Quadrate</translation>
    </message>
    <message>
        <source>List</source>
        <translation>Liste</translation>
    </message>
    <message>
        <source>Dictionary</source>
        <translation>Wörterbuch</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>Marke</translation>
    </message>
    <message>
        <source>Layout</source>
        <translation>Aufbau</translation>
    </message>
    <message>
        <source>Diameter</source>
        <translation>Durchmesser</translation>
    </message>
    <message>
        <source>Tag family</source>
        <translation>Markenfamilie</translation>
    </message>
    <message>
        <source>Gap / side</source>
        <translation>Lücke / Seite</translation>
    </message>
    <message>
        <source>Tag border</source>
        <translation>Markenrand</translation>
    </message>
    <message>
        <source>Tag step</source>
        <translation>Schrittweite</translation>
    </message>
    <message>
        <source>Numbered</source>
        <translation>Gezählt</translation>
    </message>
    <message>
        <source>First marker</source>
        <translation>Erster Marker</translation>
    </message>
    <message>
        <source>First tag</source>
        <translation>Erste Marke</translation>
    </message>
    <message>
        <source>First corner</source>
        <translation>Erste Ecke</translation>
    </message>
    <message>
        <source>The lowest number of a marker or tag on the board: 0 on most.</source>
        <translation>Die kleinste Nummer eines Markers oder Tags auf dem Brett: meist 0.</translation>
    </message>
    <message>
        <source>Choose a file…</source>
        <translation>Datei wählen…</translation>
    </message>
    <message>
        <source>{0} circles…</source>
        <translation>{0} Kreise…</translation>
    </message>
    <message>
        <source>List of circles</source>
        <translation>Liste der Kreise</translation>
    </message>
    <message>
        <source>Lists of circles (*.csv *.json)</source>
        <translation>Listen von Kreisen (*.csv *.json)</translation>
    </message>
</context>
<context>
    <name>PatternTexts</name>
    <message>
        <source>Checkerboard</source>
        <translation>Schachbrett</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard.</source>
        <translation>Das sieht nach Fotos eines Schachbretts aus.</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard</source>
        <translation>Nach einem Schachbrett &amp;suchen</translation>
    </message>
    <message>
        <source>ChArUco board</source>
        <translation>ChArUco-Brett</translation>
    </message>
    <message>
        <source>These look like photographs of a ChArUco board.</source>
        <translation>Das sieht nach Fotos eines ChArUco-Bretts aus.</translation>
    </message>
    <message>
        <source>&amp;Search for a ChArUco board</source>
        <translation>Nach einem ChArUco-Brett &amp;suchen</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>Kreise</translation>
    </message>
    <message>
        <source>These look like photographs of a grid of circles.</source>
        <translation>Das sieht nach Fotos eines Gitters von Kreisen aus.</translation>
    </message>
    <message>
        <source>&amp;Search for circles</source>
        <translation>Nach Kreisen &amp;suchen</translation>
    </message>
    <message>
        <source>Asymmetric circles</source>
        <translation>Versetzte Kreise</translation>
    </message>
    <message>
        <source>These look like photographs of an asymmetric grid of circles.</source>
        <translation>Das sieht nach Fotos eines versetzten Gitters von Kreisen aus.</translation>
    </message>
    <message>
        <source>&amp;Search for asymmetric circles</source>
        <translation>Nach versetzten Kreisen &amp;suchen</translation>
    </message>
    <message>
        <source>Circles of a list</source>
        <translation>Kreise einer Liste</translation>
    </message>
    <message>
        <source>These look like photographs of listed circles.</source>
        <translation>Das sieht nach Fotos der Kreise einer Liste aus.</translation>
    </message>
    <message>
        <source>&amp;Search for listed circles</source>
        <translation>Nach Kreisen der Liste &amp;suchen</translation>
    </message>
    <message>
        <source>AprilGrid</source>
        <translation>AprilGrid</translation>
    </message>
    <message>
        <source>These look like photographs of an AprilGrid.</source>
        <translation>Das sieht nach Fotos eines AprilGrids aus.</translation>
    </message>
    <message>
        <source>&amp;Search for an AprilGrid</source>
        <translation>Nach einem AprilGrid &amp;suchen</translation>
    </message>
    <message>
        <source>Checkerboard with tags</source>
        <translation>Schachbrett mit Marken</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard with AprilTags.</source>
        <translation>Das sieht nach Fotos eines Schachbretts mit AprilTags aus.</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard with tags</source>
        <translation>Nach einem Schachbrett mit Marken &amp;suchen</translation>
    </message>
    <message>
        <source>PuzzleBoard</source>
        <translation>PuzzleBoard</translation>
    </message>
    <message>
        <source>These look like photographs of a PuzzleBoard.</source>
        <translation>Das sieht nach Fotos eines PuzzleBoards aus.</translation>
    </message>
    <message>
        <source>&amp;Search for a PuzzleBoard</source>
        <translation>Nach einem PuzzleBoard &amp;suchen</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Ecken</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>Innere Ecken</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation type="unfinished">Abstand</translation>
    </message>
    <message>
        <source>Tag</source>
        <translation type="unfinished">Marke</translation>
    </message>
    <message>
        <source>Square</source>
        <translation type="unfinished">Quadrat</translation>
    </message>
</context>
<context>
    <name>PlaneChoice</name>
    <message>
        <source>in the image</source>
        <translation>im Bild</translation>
    </message>
    <message>
        <source>on the reference plane</source>
        <translation>auf der Referenzebene</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>Referenz-px</translation>
    </message>
    <message>
        <source>In the image a residual is the measured less the predicted corner.
The paper&apos;s reference plane has 30 px to a square; residuals of far and tilted
boards look larger there (figures 10 to 12).</source>
        <translation>Im Bild ist ein Residuum die gemessene minus die vorhergesagte Ecke.
Die Referenzebene des Aufsatzes hat 30 px je Quadrat; Residuen ferner und geneigter
Bretter sehen dort größer aus (Bilder 10 bis 12).</translation>
    </message>
    <message>
        <source>Where residuals are shown</source>
        <translation>Wo Residuen gezeigt werden</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
</context>
<context>
    <name>Plot</name>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Copy as image</source>
        <translation>Als Bild kopieren</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>Diagramm speichern…</translation>
    </message>
</context>
<context>
    <name>PoseErrors</name>
    <message>
        <source>relative error of an external parameter</source>
        <translation>relativer Fehler eines äußeren Parameters</translation>
    </message>
    <message>
        <source>count</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>|z real − z synthetic| / |z real| of eq. 51 (figure 14).</source>
        <translation>|z echt − z synthetisch| / |z echt| nach Gl. 51 (Bild 14).</translation>
    </message>
    <message>
        <source>median {0:.3g} %, largest {1:.3g} %</source>
        <translation>Median {0:.3g} %, größter {1:.3g} %</translation>
    </message>
</context>
<context>
    <name>PosesPanel</name>
    <message>
        <source>Poses</source>
        <translation>Lagen</translation>
    </message>
    <message>
        <source>Where the board was held before the camera, in space: the extrinsics.</source>
        <translation>Wo das Brett vor der Kamera gehalten wurde, im Raum: die äußere Orientierung.</translation>
    </message>
    <message>
        <source>Camera at rest</source>
        <translation>Kamera ruht</translation>
    </message>
    <message>
        <source>Board at rest</source>
        <translation>Brett ruht</translation>
    </message>
    <message>
        <source>What stands still in the picture: the camera, with the boards around it, or the board, with the cameras around it.</source>
        <translation>Was im Bild stillsteht: die Kamera mit den Brettern um sie, oder das Brett mit den Kameras darum.</translation>
    </message>
    <message>
        <source>What stands still</source>
        <translation>Was stillsteht</translation>
    </message>
    <message>
        <source>&amp;Reset view</source>
        <translation>Blick &amp;zurücksetzen</translation>
    </message>
    <message>
        <source>Show everything, from where it was seen first</source>
        <translation>Alles zeigen, von wo es zuerst zu sehen war</translation>
    </message>
    <message>
        <source>Drag to turn, wheel to zoom, click a board or camera to see its image.</source>
        <translation>Ziehen dreht, das Rad vergrößert; ein Brett oder eine Kamera anklicken zeigt ihr Bild.</translation>
    </message>
    <message>
        <source>Camera and boards in space</source>
        <translation>Kamera und Bretter im Raum</translation>
    </message>
    <message>
        <source>{0}: {1:.0f} mm away{2}, tilted by {3:.0f}°</source>
        <translation>{0}: {1:.0f} mm entfernt{2}, {3:.0f}° geneigt</translation>
    </message>
    <message>
        <source>{0} views, {1:.0f} to {2:.0f} mm away{3}, tilted by {4:.0f}° to {5:.0f}°</source>
        <translation>{0} Ansichten, {1:.0f} bis {2:.0f} mm entfernt{3}, {4:.0f}° bis {5:.0f}° geneigt</translation>
    </message>
</context>
<context>
    <name>Preparation</name>
    <message>
        <source>Compiling for speed, once</source>
        <translation type="unfinished">Einmalig für Tempo übersetzen</translation>
    </message>
</context>
<context>
    <name>PrintDialog</name>
    <message>
        <source>Board to print</source>
        <translation>Brett zum Drucken</translation>
    </message>
    <message>
        <source>usual</source>
        <translation>üblich</translation>
    </message>
    <message>
        <source>Rows</source>
        <translation>Zeilen</translation>
    </message>
    <message>
        <source>Columns</source>
        <translation>Spalten</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>&amp;Paper</source>
        <translation>&amp;Papier</translation>
    </message>
    <message>
        <source>An odd and an even number of squares
lets every view find the same origin.</source>
        <translation>Eine ungerade und eine gerade Zahl von Quadraten
lässt jede Ansicht denselben Ursprung finden.</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Speichern…</translation>
    </message>
    <message>
        <source>Show on this scr&amp;een</source>
        <translation>Auf diesem &amp;Bildschirm zeigen</translation>
    </message>
    <message>
        <source>As large as the screen holds it: a screen is flat, and needs no printer</source>
        <translation>So groß, wie der Bildschirm es fasst: er ist eben und braucht keinen Drucker</translation>
    </message>
    <message>
        <source>Tags</source>
        <translation>Marken</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>Seite einer Marke</translation>
    </message>
    <message>
        <source>Squares</source>
        <translation>Quadrate</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Seite eines Quadrats</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>Kreise</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>Abstand</translation>
    </message>
    <message>
        <source>Fits. Print it without scaling.</source>
        <translation>Passt. Ohne Skalierung drucken.</translation>
    </message>
    <message>
        <source>Save board</source>
        <translation>Brett speichern</translation>
    </message>
    <message>
        <source>PDF (*.pdf);;SVG drawing (*.svg);;PNG image (*.png)</source>
        <translation>PDF (*.pdf);;SVG-Zeichnung (*.svg);;PNG-Bild (*.png)</translation>
    </message>
</context>
<context>
    <name>Progress</name>
    <message>
        <source>Stop this; what is finished stays (Shift+F9)</source>
        <translation>Das anhalten; Fertiges bleibt (Umschalt+F9)</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Stopping…</source>
        <translation>Hält an…</translation>
    </message>
    <message>
        <source>: {0} of {1}</source>
        <translation>: {0} von {1}</translation>
    </message>
    <message>
        <source>, {0} left</source>
        <translation>, noch {0}</translation>
    </message>
</context>
<context>
    <name>ProgressFigure</name>
    <message>
        <source>How far the capture has come</source>
        <translation>Wie weit die Aufnahme gekommen ist</translation>
    </message>
    <message>
        <source>The ring: the uncertainty of the worst pixel, one standard deviation, and the one that is asked for.
The rectangle: the corners in all pictures, over the sensor.
The circle: how the boards were tilted; the middle is facing the camera, the rim 60 degrees.</source>
        <translation>Der Ring: die Unsicherheit des schlechtesten Pixels, eine Standardabweichung, und die geforderte.
Das Rechteck: die Ecken in allen Bildern, über dem Sensor.
Der Kreis: wie die Bretter geneigt waren; die Mitte ist zur Kamera hin, der Rand 60 Grad.</translation>
    </message>
    <message>
        <source>nothing taken</source>
        <translation>nichts aufgenommen</translation>
    </message>
    <message>
        <source>{0} taken, not determined yet</source>
        <translation>{0} aufgenommen, noch unbestimmt</translation>
    </message>
    <message>
        <source>{0} taken, worst pixel ±{1} px of {2}</source>
        <translation>{0} aufgenommen, schlechtestes Pixel ±{1} px von {2}</translation>
    </message>
    <message>
        <source>±{0} px</source>
        <translation>±{0} px</translation>
    </message>
    <message>
        <source>of {0} px</source>
        <translation>von {0} px</translation>
    </message>
    <message>
        <source>corners on the sensor</source>
        <translation>Ecken auf dem Sensor</translation>
    </message>
    <message>
        <source>tilts</source>
        <translation>Neigungen</translation>
    </message>
</context>
<context>
    <name>RemedyRunner</name>
    <message>
        <source>Calibration</source>
        <translation>Kalibrierung</translation>
    </message>
</context>
<context>
    <name>ReportDialog</name>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>All that is known</source>
        <translation>Alles, was bekannt ist</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Zertifikat</translation>
    </message>
    <message>
        <source>After ISO/IEC 17025, 7.8.2 and 7.8.4</source>
        <translation>Nach ISO/IEC 17025, 7.8.2 und 7.8.4</translation>
    </message>
    <message>
        <source>Letter</source>
        <translation>Letter</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation>nicht angegeben</translation>
    </message>
    <message>
        <source>&amp;Layout</source>
        <translation>&amp;Aufbau</translation>
    </message>
    <message>
        <source>Pa&amp;per</source>
        <translation>Pa&amp;pier</translation>
    </message>
    <message>
        <source>What stands here is kept with the project. For PDF: pip install &apos;calibgui[report]&apos;.</source>
        <translation>Was hier steht, wird im Projekt behalten. Für PDF: pip install &apos;calibgui[report]&apos;.</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Speichern…</translation>
    </message>
    <message>
        <source>Number of the report</source>
        <translation>Nummer des Berichts</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bearbeiter</translation>
    </message>
    <message>
        <source>Laboratory</source>
        <translation>Labor</translation>
    </message>
    <message>
        <source>Place of calibration</source>
        <translation>Ort der Kalibrierung</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>Temperatur</translation>
    </message>
    <message>
        <source>Customer</source>
        <translation>Kunde</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Serial number of the camera</source>
        <translation>Seriennummer der Kamera</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Linse</translation>
    </message>
    <message>
        <source>Serial number of the lens</source>
        <translation>Seriennummer der Linse</translation>
    </message>
    <message>
        <source>Aperture, focus, zoom</source>
        <translation>Blende, Fokus, Zoom</translation>
    </message>
    <message>
        <source>Condition of the item</source>
        <translation>Zustand des Gegenstands</translation>
    </message>
    <message>
        <source>Date of receipt</source>
        <translation>Eingangsdatum</translation>
    </message>
    <message>
        <source>Date of calibration</source>
        <translation>Datum der Kalibrierung</translation>
    </message>
    <message>
        <source>Identification of the board</source>
        <translation>Kennzeichen des Bretts</translation>
    </message>
    <message>
        <source>Certificate of the board</source>
        <translation>Zertifikat des Bretts</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Bemerkungen</translation>
    </message>
    <message>
        <source>Authorised by</source>
        <translation>Freigegeben von</translation>
    </message>
    <message>
        <source>Details of the report</source>
        <translation>Angaben zum Bericht</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>{0} schreiben</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
</context>
<context>
    <name>ResidualsPanel</name>
    <message>
        <source>Residuals</source>
        <translation>Residuen</translation>
    </message>
    <message>
        <source>Measured minus predicted corners.</source>
        <translation>Gemessene minus vorhergesagte Ecken.</translation>
    </message>
    <message>
        <source>Click a point to see its corner in the image.</source>
        <translation>Einen Punkt anklicken zeigt seine Ecke im Bild.</translation>
    </message>
    <message>
        <source>{0}: mean {1:.3f}, SD {2:.3f} {3}</source>
        <translation>{0}: Mittel {1:.3f}, Std. {2:.3f} {3}</translation>
    </message>
    <message>
        <source>σ: {0} {1:.3f}, {2} {3:.3f} px</source>
        <translation>σ: {0} {1:.3f}, {2} {3:.3f} px</translation>
    </message>
    <message>
        <source>Do the residuals look like noise? Working…</source>
        <translation>Sehen die Residuen wie Rauschen aus? Rechnet…</translation>
    </message>
    <message>
        <source>Examining the residuals</source>
        <translation>Residuen untersuchen</translation>
    </message>
    <message>
        <source>Whether the residuals look like noise was not examined.</source>
        <translation>Ob die Residuen wie Rauschen aussehen, wurde nicht untersucht.</translation>
    </message>
    <message>
        <source>The residuals look like noise: nothing speaks against the ± of the result.</source>
        <translation>Die Residuen sehen wie Rauschen aus: nichts spricht gegen das ± des Ergebnisses.</translation>
    </message>
    <message>
        <source> Beyond {0:g} σ: {1} in {2}, each within its own uncertainty.</source>
        <translation> Jenseits {0:g} σ: {1} in {2}, jede innerhalb ihrer eigenen Unsicherheit.</translation>
    </message>
    <message>
        <source>The residuals are not just noise. Why is being tried.</source>
        <translation>Die Residuen sind nicht nur Rauschen. Warum, wird untersucht.</translation>
    </message>
    <message>
        <source>The residuals are not just noise, but no cause of it stands out that matters.</source>
        <translation>Die Residuen sind nicht nur Rauschen, aber keine Ursache von Belang tritt hervor.</translation>
    </message>
    <message>
        <source>The residuals are not just noise. {0} {1}</source>
        <translation>Die Residuen sind nicht nur Rauschen. {0} {1}</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>The camera&apos;s parameters with their standard deviations, and what they are worth.</source>
        <translation>Die Parameter der Kamera mit ihren Standardabweichungen, und was sie taugen.</translation>
    </message>
    <message>
        <source>Summary</source>
        <translation>Übersicht</translation>
    </message>
    <message>
        <source>Estimates near ±1 can stand in for each other: only a combination is known.</source>
        <translation>Schätzungen nahe ±1 können einander vertreten: nur eine Kombination ist bekannt.</translation>
    </message>
    <message>
        <source>The paper&apos;s units</source>
        <translation>Einheiten des Aufsatzes</translation>
    </message>
    <message>
        <source>Correlations</source>
        <translation>Korrelationen</translation>
    </message>
    <message>
        <source>What this result is worth is being found out.</source>
        <translation>Was dieses Ergebnis taugt, wird ermittelt.</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Remark</source>
        <translation>Bemerkung</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>Std. nach Tabelle 2</translation>
    </message>
    <message>
        <source>The paper&apos;s sqrt(diag((2 JᵀJ)⁻¹)), which leaves the residuals out.
1σ is what the residuals support.</source>
        <translation>sqrt(diag((2 JᵀJ)⁻¹)) des Aufsatzes, ohne die Größe der Residuen.
1σ ist, was die Residuen stützen.</translation>
    </message>
    <message>
        <source>held</source>
        <translation>fest</translation>
    </message>
    <message>
        <source>not determined</source>
        <translation>unbestimmt</translation>
    </message>
    <message>
        <source>assumed</source>
        <translation>angenommen</translation>
    </message>
    <message>
        <source>may be 0</source>
        <translation>evtl. 0</translation>
    </message>
</context>
<context>
    <name>RigAnswer</name>
    <message>
        <source>Where the cameras stand</source>
        <translation>Wo die Kameras stehen</translation>
    </message>
    <message>
        <source>Where the boards stand</source>
        <translation>Wo die Bretter stehen</translation>
    </message>
    <message>
        <source>Cameras</source>
        <translation>Kameras</translation>
    </message>
    <message>
        <source>Points ahead</source>
        <translation>Punkte voraus</translation>
    </message>
    <message>
        <source>The cameras agree</source>
        <translation>Die Kameras stimmen überein</translation>
    </message>
    <message>
        <source>Photographs contradict</source>
        <translation>Fotos widersprechen sich</translation>
    </message>
    <message>
        <source>The instants disagree</source>
        <translation>Die Zeitpunkte stimmen nicht überein</translation>
    </message>
    <message>
        <source>All lengths hold {0}.</source>
        <translation>Alle Längen gelten {0}.</translation>
    </message>
    <message>
        <source>camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Root mean square residual of this camera in the rig, px</source>
        <translation>RMS-Residuum dieser Kamera im Rig, px</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Zahl der Ecken</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>Entfernung</translation>
    </message>
    <message>
        <source>± along</source>
        <translation>± längs</translation>
    </message>
    <message>
        <source>Standard deviation along the line of sight, with this rig&apos;s noise, mm</source>
        <translation>Standardabweichung entlang der Sichtlinie, mit dem Rauschen dieses Rigs, mm</translation>
    </message>
    <message>
        <source>± across</source>
        <translation>± quer</translation>
    </message>
    <message>
        <source>calib.</source>
        <translation>Kalib.</translation>
    </message>
    <message>
        <source>Part of the variance that the calibration is to blame for, %</source>
        <translation>Anteil der Varianz, den die Kalibrierung verschuldet, %</translation>
    </message>
    <message>
        <source>from {0}</source>
        <translation>von {0}</translation>
    </message>
    <message>
        <source>Distance of the two cameras&apos; centres, mm</source>
        <translation>Abstand der Mitten beider Kameras, mm</translation>
    </message>
    <message>
        <source>turn</source>
        <translation>Drehung</translation>
    </message>
    <message>
        <source>Angle between the two cameras, degrees</source>
        <translation>Winkel zwischen beiden Kameras, Grad</translation>
    </message>
    <message>
        <source>{0} from {1}</source>
        <translation>{0} von {1}</translation>
    </message>
    <message>
        <source>board</source>
        <translation>Brett</translation>
    </message>
    <message>
        <source>from board {0}</source>
        <translation>von Brett {0}</translation>
    </message>
    <message>
        <source>Distance of the boards&apos; origins, mm</source>
        <translation>Abstand der Ursprünge der Bretter, mm</translation>
    </message>
    <message>
        <source>Angle between the boards, degrees</source>
        <translation>Winkel zwischen den Brettern, Grad</translation>
    </message>
</context>
<context>
    <name>RigForm</name>
    <message>
        <source>Shape of the boards</source>
        <translation>Form der Bretter</translation>
    </message>
    <message>
        <source> ms</source>
        <translation> ms</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation type="unfinished">automatisch</translation>
    </message>
    <message>
        <source>Photographs that were taken at most so far apart are of one instant: by their names (seconds or nanoseconds since 1970, as of ROS) or by EXIF</source>
        <translation>Fotos, die höchstens so weit auseinander aufgenommen wurden, gehören zu einem Zeitpunkt: nach ihren Namen (Sekunden oder Nanosekunden seit 1970, wie bei ROS) oder nach EXIF</translation>
    </message>
    <message>
        <source>Pair photographs taken within</source>
        <translation>Fotos zuordnen innerhalb von</translation>
    </message>
    <message>
        <source>one of </source>
        <translation>eines von </translation>
    </message>
    <message>
        <source>all</source>
        <translation type="unfinished">alle</translation>
    </message>
    <message>
        <source>Frames of videos that are taken</source>
        <translation>Bilder, die aus Videos genommen werden</translation>
    </message>
    <message>
        <source>Leave out what no camera e&amp;xplains</source>
        <translation type="unfinished">&amp;Weglassen, was keine Kamera erklärt</translation>
    </message>
    <message>
        <source>Corners and views that no camera explains take no part</source>
        <translation type="unfinished">Ecken und Ansichten, die keine Kamera erklärt, bleiben außen vor</translation>
    </message>
    <message>
        <source>Estimate how late each camera &amp;is</source>
        <translation>&amp;Verspätung jeder Kamera schätzen</translation>
    </message>
    <message>
        <source>From a board that moves, in videos or in photographs that are paired by time: the clock of each camera may be late</source>
        <translation>Aus einem bewegten Brett, in Videos oder in Fotos, die nach der Zeit zusammengeführt sind: Die Uhr jeder Kamera kann nachgehen</translation>
    </message>
    <message>
        <source>The boards are</source>
        <translation>Die Bretter sind</translation>
    </message>
    <message>
        <source>Frames of videos</source>
        <translation>Bilder aus Videos</translation>
    </message>
</context>
<context>
    <name>RigPage</name>
    <message>
        <source>Pairing photographs</source>
        <translation>Fotos zuordnen</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>{0} öffnen</translation>
    </message>
    <message>
        <source>&amp;Folders…</source>
        <translation>&amp;Ordner…</translation>
    </message>
    <message>
        <source>O&amp;pen rig…</source>
        <translation>Rig ö&amp;ffnen…</translation>
    </message>
    <message>
        <source>&amp;Calibrate rig</source>
        <translation>Rig &amp;kalibrieren</translation>
    </message>
    <message>
        <source>&amp;Stop</source>
        <translation>&amp;Anhalten</translation>
    </message>
    <message>
        <source>C&amp;lose</source>
        <translation>Sch&amp;ließen</translation>
    </message>
    <message>
        <source>Set-&amp;up</source>
        <translation>Einrichtu&amp;ng</translation>
    </message>
    <message>
        <source>What is stated of boards and photographs, to change it</source>
        <translation>Was zu Brettern und Fotos angegeben ist, zum Ändern</translation>
    </message>
    <message>
        <source>E&amp;xport</source>
        <translation>E&amp;xportieren</translation>
    </message>
    <message>
        <source>Rig, with everything (JSON)…</source>
        <translation>Rig, mit allem (JSON)…</translation>
    </message>
    <message>
        <source>Photographs</source>
        <translation>Fotos</translation>
    </message>
    <message>
        <source>Rectified</source>
        <translation>Rektifiziert</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>3-D</translation>
    </message>
    <message>
        <source>Several cameras</source>
        <translation>Mehrere Kameras</translation>
    </message>
    <message>
        <source>Cameras that stand fast to each other and photograph one board together: choose the folder that holds a folder for each camera (or all photographs, named as left01 and right01), or drop the folders here, or a video of each camera.</source>
        <translation>Kameras, die fest zueinander stehen und gemeinsam ein Brett fotografieren: Wählen Sie den Ordner, der für jede Kamera einen Ordner enthält (oder alle Fotos, benannt wie left01 und right01), oder ziehen Sie die Ordner hierher, oder ein Video jeder Kamera.</translation>
    </message>
    <message>
        <source>No photographs yet.</source>
        <translation>Noch keine Fotos.</translation>
    </message>
    <message>
        <source>Calibrate the rig first.</source>
        <translation>Erst das Rig kalibrieren.</translation>
    </message>
    <message>
        <source>No two cameras have a photograph of one instant.</source>
        <translation>Keine zwei Kameras haben ein Foto eines Zeitpunkts.</translation>
    </message>
    <message>
        <source>{0} and {1} have no photographs of this instant together.</source>
        <translation>{0} und {1} haben keine gemeinsamen Fotos dieses Zeitpunkts.</translation>
    </message>
    <message>
        <source>Searching</source>
        <translation>Sucht ab</translation>
    </message>
    <message>
        <source>Calibrating {0}</source>
        <translation>{0} kalibrieren</translation>
    </message>
    <message>
        <source>Lengths hold {0}.</source>
        <translation>Längen gelten {0}.</translation>
    </message>
    <message>
        <source>Folder with a folder for each camera, or the photographs of all</source>
        <translation>Ordner mit einem Ordner für jede Kamera oder den Fotos aller</translation>
    </message>
    <message>
        <source>Open rig</source>
        <translation>Rig öffnen</translation>
    </message>
    <message>
        <source>Rigs (*.json)</source>
        <translation>Rigs (*.json)</translation>
    </message>
    <message>
        <source>Save rig</source>
        <translation>Rig speichern</translation>
    </message>
    <message>
        <source>Wrote {0}.</source>
        <translation>{0} geschrieben.</translation>
    </message>
</context>
<context>
    <name>RoiBar</name>
    <message>
        <source>&amp;Accept</source>
        <translation>&amp;Annehmen</translation>
    </message>
    <message>
        <source>Lea&amp;ve</source>
        <translation>&amp;Verlassen</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>Zeilen innerer Ecken</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>Spalten innerer Ecken</translation>
    </message>
    <message>
        <source>As counted between the clicks, with those clicked. State it if the count is wrong.</source>
        <translation>Wie zwischen den Klicks gezählt, diese eingeschlossen. Angeben, wenn die Zahl falsch ist.</translation>
    </message>
    <message>
        <source>Keep these corners and go on (Enter)</source>
        <translation>Diese Ecken behalten und weitergehen (Enter)</translation>
    </message>
    <message>
        <source>Leave the image as it was (Esc)</source>
        <translation>Das Bild lassen, wie es war (Esc)</translation>
    </message>
</context>
<context>
    <name>Saver</name>
    <message>
        <source>The program&apos;s own folder cannot be used: recent projects and work that is not saved are kept in {0}, until the computer is started anew. Check HOME.</source>
        <translation>Der eigene Ordner des Programms ist nicht benutzbar: letzte Projekte und Ungespeichertes liegen in {0}, bis der Rechner neu startet. HOME prüfen.</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>{0} öffnen</translation>
    </message>
    <message>
        <source>{0} is open in another window, too ({1}). What is saved there is not seen here; before it is replaced you are asked.</source>
        <translation>{0} ist auch in einem anderen Fenster offen ({1}). Was dort gespeichert wird, ist hier nicht zu sehen; vor dem Ersetzen wird gefragt.</translation>
    </message>
    <message>
        <source>Recovering {0}</source>
        <translation>{0} wiederherstellen</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Ohne Namen</translation>
    </message>
    <message>
        <source>Saving {0}</source>
        <translation>{0} speichern</translation>
    </message>
</context>
<context>
    <name>Scatters</name>
    <message>
        <source>real</source>
        <translation>echt</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>synthetisch</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>Referenz-px</translation>
    </message>
</context>
<context>
    <name>SensorFigure</name>
    <message>
        <source>How far off the camera puts a distant point in the image (one standard deviation), as the verdict has it: beside the camera that mends the findings, if there are any.
The colours: where the calibration&apos;s own uncertainty is small (dark) and large.</source>
        <translation>Wie weit die Kamera einen fernen Punkt im Bild danebensetzt (eine Standardabweichung), nach dem Urteil: verglichen mit der Kamera, die die Befunde behebt, falls es welche gibt.
Die Farben: wo die eigene Unsicherheit der Kalibrierung klein (dunkel) und groß ist.</translation>
    </message>
    <message>
        <source>Error of a pixel</source>
        <translation>Fehler eines Pixels</translation>
    </message>
    <message>
        <source>Now: {0}</source>
        <translation>Jetzt: {0}</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>Mitte</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>Rand</translation>
    </message>
    <message>
        <source>worst pixel</source>
        <translation>größter</translation>
    </message>
</context>
<context>
    <name>Sentences</name>
    <message>
        <source>The photographs show nothing wrong.</source>
        <translation>An den Fotos ist nichts auszusetzen.</translation>
    </message>
    <message>
        <source>The views do not determine the camera.</source>
        <translation>Die Ansichten bestimmen die Kamera nicht.</translation>
    </message>
    <message>
        <source>The calibration is not finished.</source>
        <translation>Die Kalibrierung ist nicht fertig.</translation>
    </message>
    <message>
        <source>One view cannot be checked.</source>
        <translation>Eine Ansicht lässt sich nicht prüfen.</translation>
    </message>
    <message>
        <source>{0} views are too few.</source>
        <translation>{0} Ansichten sind zu wenige.</translation>
    </message>
    <message>
        <source>{0} views are too few: take {1} or more, tilted in all directions.</source>
        <translation>{0} Ansichten sind zu wenige: {1} oder mehr machen, in alle Richtungen geneigt.</translation>
    </message>
    <message>
        <source>The camera is not known well enough: add photographs.</source>
        <translation>Die Kamera ist nicht gut genug bekannt: Fotos hinzufügen.</translation>
    </message>
    <message>
        <source>Nothing needs to be done: the camera is known to {0} px.</source>
        <translation>Es ist nichts zu tun: Die Kamera ist auf {0} px bekannt.</translation>
    </message>
    <message>
        <source>The camera is known to {0} px.</source>
        <translation>Die Kamera ist auf {0} px bekannt.</translation>
    </message>
    <message>
        <source>The photographs show nothing wrong, but the camera is known to {0} px only: add photographs.</source>
        <translation>An den Fotos ist nichts auszusetzen, aber die Kamera ist nur auf {0} px bekannt: Fotos hinzufügen.</translation>
    </message>
    <message>
        <source>Nothing is wrong where corners were seen: the camera is known to {0} px.</source>
        <translation>Wo Ecken gesehen wurden, ist nichts auszusetzen: Die Kamera ist dort auf {0} px bekannt.</translation>
    </message>
    <message>
        <source>Beyond them it is known to {0} px: hold the board closer to the image&apos;s edges.</source>
        <translation>Außerhalb ist sie auf {0} px bekannt: das Brett näher an die Bildränder halten.</translation>
    </message>
    <message>
        <source>Beyond them it is not known: hold the board closer to the image&apos;s edges.</source>
        <translation>Außerhalb ist sie unbekannt: das Brett näher an die Bildränder halten.</translation>
    </message>
    <message>
        <source>Add views with the board tilted by {0} to {1} degrees in different directions and all over the image; six good ones are enough.</source>
        <translation>Ansichten hinzufügen, das Brett um {0} bis {1} Grad in verschiedene Richtungen geneigt und über das ganze Bild verteilt; sechs gute genügen.</translation>
    </message>
    <message>
        <source>The views are too few, or too much alike.</source>
        <translation>Die Ansichten sind zu wenige oder einander zu ähnlich.</translation>
    </message>
    <message>
        <source>Your board is not printed true.</source>
        <translation>Ihr Brett ist nicht maßhaltig gedruckt.</translation>
    </message>
    <message>
        <source>Your board is not flat.</source>
        <translation>Ihr Brett ist nicht eben.</translation>
    </message>
    <message>
        <source>Your board is not flat, or not printed true.</source>
        <translation>Ihr Brett ist nicht eben oder nicht maßhaltig gedruckt.</translation>
    </message>
    <message>
        <source>Your board is not flat ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>Ihr Brett ist nicht eben ({0} mm): seine Form wurde geschätzt; Fehler {1}-mal kleiner.</translation>
    </message>
    <message>
        <source>Your board is not printed true ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>Ihr Brett ist nicht maßhaltig gedruckt ({0} mm): seine Form wurde geschätzt; Fehler {1}-mal kleiner.</translation>
    </message>
    <message>
        <source>The lens model {0} does not follow this lens.</source>
        <translation>Das Linsenmodell {0} folgt dieser Linse nicht.</translation>
    </message>
    <message>
        <source>{0} does not belong to the others.</source>
        <translation>{0} gehört nicht zu den anderen.</translation>
    </message>
    <message>
        <source>{0} do not belong to the others.</source>
        <translation>{0} gehören nicht zu den anderen.</translation>
    </message>
    <message>
        <source>{0} is blurred, which does no harm here.</source>
        <translation>{0} ist unscharf, was hier nicht schadet.</translation>
    </message>
    <message>
        <source>{0} are blurred, which does no harm here.</source>
        <translation>{0} sind unscharf, was hier nicht schadet.</translation>
    </message>
    <message>
        <source>The images were scaled, by the camera or a program.</source>
        <translation>Die Bilder wurden skaliert, von der Kamera oder einem Programm.</translation>
    </message>
    <message>
        <source>One view does not determine a camera, which leaves {0} unknown.</source>
        <translation>Eine Ansicht bestimmt keine Kamera: {0} bleibt unbekannt.</translation>
    </message>
    <message>
        <source>The focal length differs between the views.</source>
        <translation>Die Brennweite ist in den Ansichten verschieden.</translation>
    </message>
    <message>
        <source>Switch autofocus and stabilisation off, and do not touch zoom and focus.</source>
        <translation>Autofokus und Stabilisierung ausschalten und Zoom und Fokus nicht anfassen.</translation>
    </message>
    <message>
        <source>Some views show the corners less well than the others.</source>
        <translation>Einige Ansichten zeigen die Ecken schlechter als die anderen.</translation>
    </message>
    <message>
        <source>Tool ± {0} mm, ± {1} degrees (k = 2); robot {2} %, camera {3} %, from {4} poses</source>
        <translation>Werkzeug ± {0} mm, ± {1} Grad (k = 2); Roboter {2} %, Kamera {3} %, aus {4} Posen</translation>
    </message>
    <message>
        <source>The robot&apos;s poses are {0}.</source>
        <translation>Die Posen des Roboters sind {0}.</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in degrees, {1}</source>
        <translation>Winkel a, b, c von {0} in Grad, {1}</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in radians, {1}</source>
        <translation>Winkel a, b, c von {0} in Radiant, {1}</translation>
    </message>
    <message>
        <source>rotation vectors in degrees, {0}</source>
        <translation>Drehvektoren in Grad, {0}</translation>
    </message>
    <message>
        <source>rotation vectors in radians, {0}</source>
        <translation>Drehvektoren in Radiant, {0}</translation>
    </message>
    <message>
        <source>quaternions {0}</source>
        <translation>Quaternionen {0}</translation>
    </message>
    <message>
        <source>x, y, z, w, {0}</source>
        <translation>x, y, z, w, {0}</translation>
    </message>
    <message>
        <source>w, x, y, z, {0}</source>
        <translation>w, x, y, z, {0}</translation>
    </message>
    <message>
        <source>matrices row by row, {0}</source>
        <translation>Matrizen zeilenweise, {0}</translation>
    </message>
    <message>
        <source>matrices column by column, {0}</source>
        <translation>Matrizen spaltenweise, {0}</translation>
    </message>
    <message>
        <source>rotations transposed, {0}</source>
        <translation>Drehungen transponiert, {0}</translation>
    </message>
    <message>
        <source>millimetres, {0}</source>
        <translation>Millimeter, {0}</translation>
    </message>
    <message>
        <source>metres, {0}</source>
        <translation>Meter, {0}</translation>
    </message>
    <message>
        <source>base from hand</source>
        <translation>Basis aus Hand</translation>
    </message>
    <message>
        <source>hand from base</source>
        <translation>Hand aus Basis</translation>
    </message>
    <message>
        <source>camera in the hand</source>
        <translation>Kamera in der Hand</translation>
    </message>
    <message>
        <source>camera beside the robot</source>
        <translation>Kamera neben dem Roboter</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm.</source>
        <translation>So gelesen streut das Brett um {0} mm.</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm, and by {1} mm in any other way.</source>
        <translation>So gelesen streut das Brett um {0} mm, auf jede andere Art um {1} mm.</translation>
    </message>
    <message>
        <source>A pose of the robot is off by {0} mm along each axis and by {1} degrees about each, one standard deviation.</source>
        <translation>Eine Pose des Roboters ist um {0} mm entlang und um {1} Grad um jede Achse falsch, eine Standardabweichung.</translation>
    </message>
    <message>
        <source>The corners are off by {0} px.</source>
        <translation>Die Ecken liegen um {0} px daneben.</translation>
    </message>
    <message>
        <source>The poses fit as well as {0}.</source>
        <translation>Die Posen passen ebenso gut als {0}.</translation>
    </message>
    <message>
        <source>Turn the hand about more axes, or state where the camera is (above).</source>
        <translation>Drehen Sie die Hand um mehr Achsen, oder geben Sie oben an, wo die Kamera ist.</translation>
    </message>
    <message>
        <source>Correct the file.</source>
        <translation>Berichtigen Sie die Datei.</translation>
    </message>
    <message>
        <source>{0} have the same pose of the robot: if it moved between them, the file is wrong.</source>
        <translation>{0} haben dieselbe Pose des Roboters: Wenn er sich dazwischen bewegt hat, ist die Datei falsch.</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the hand.</source>
        <translation>Offen: Die Kamera kann um {0} der Hand gedreht sein.</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the base.</source>
        <translation>Offen: Die Kamera kann um {0} der Basis gedreht sein.</translation>
    </message>
    <message>
        <source>any axis</source>
        <translation>jede Achse</translation>
    </message>
    <message>
        <source>Turn the hand about another axis as well, or move it without turning.</source>
        <translation>Drehen Sie die Hand auch um eine andere Achse, oder bewegen Sie sie ohne Drehung.</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the hand.</source>
        <translation>Offen: Die Kamera kann entlang {0} der Hand verschoben sein.</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the base.</source>
        <translation>Offen: Die Kamera kann entlang {0} der Basis verschoben sein.</translation>
    </message>
    <message>
        <source>All else is determined, and no ± counts this.</source>
        <translation>Alles andere ist bestimmt, und kein ± zählt dies mit.</translation>
    </message>
    <message>
        <source>Turn the hand about {0}, or measure it.</source>
        <translation>Drehen Sie die Hand um {0}, oder messen Sie es.</translation>
    </message>
    <message>
        <source>a second axis</source>
        <translation>eine zweite Achse</translation>
    </message>
    <message>
        <source>two axes</source>
        <translation>zwei Achsen</translation>
    </message>
    <message>
        <source>other axes</source>
        <translation>andere Achsen</translation>
    </message>
    <message>
        <source>The robot&apos;s pose does not fit in {0}: another moment, or a mistake in the file.</source>
        <translation>Die Pose des Roboters passt nicht in {0}: ein anderer Zeitpunkt, oder ein Fehler in der Datei.</translation>
    </message>
    <message>
        <source>Left out: {0}</source>
        <translation>Ausgelassen: {0}</translation>
    </message>
    <message>
        <source>No ± counts the camera&apos;s errors: its file does not state them.</source>
        <translation>Kein ± zählt die Fehler der Kamera mit: Ihre Datei nennt sie nicht.</translation>
    </message>
    <message>
        <source>The robot&apos;s poses do not fit the photographs, however they are read: at best the board scatters by {0} mm in the robot&apos;s frame.</source>
        <translation>Die Posen des Roboters passen nicht zu den Fotos, wie man sie auch liest: Bestenfalls streut das Brett um {0} mm im Koordinatensystem des Roboters.</translation>
    </message>
    <message>
        <source>Check that they are the poses of these photographs in this order, and that board and camera stayed fixed, one to the hand and the other to the base.</source>
        <translation>Prüfen Sie, ob es die Posen dieser Fotos in dieser Reihenfolge sind, und ob Brett und Kamera fest blieben, eines an der Hand, das andere an der Basis.</translation>
    </message>
    <message>
        <source>By the robot&apos;s motions the board&apos;s squares are {0} times as long as stated.</source>
        <translation>Nach den Bewegungen des Roboters sind die Quadrate des Bretts {0}-mal so lang wie angegeben.</translation>
    </message>
    <message>
        <source>State the side of a square as it was printed.</source>
        <translation>Geben Sie die Seite eines Quadrats an, wie es gedruckt wurde.</translation>
    </message>
    <message>
        <source>There are {0} different poses of the robot with a board; hand and eye need at least {1}.</source>
        <translation>Es gibt {0} verschiedene Posen des Roboters mit einem Brett; Hand und Auge brauchen mindestens {1}.</translation>
    </message>
    <message>
        <source>Photograph the board from ten poses or more, turned about two axes at least.</source>
        <translation>Fotografieren Sie das Brett aus zehn oder mehr Posen, um mindestens zwei Achsen gedreht.</translation>
    </message>
    <message>
        <source>{0} has {1} poses, and there are {2} photographs.</source>
        <translation>{0} hat {1} Posen, und es gibt {2} Fotos.</translation>
    </message>
    <message>
        <source>Give a pose for each photograph, in the order of their names, or name the photographs in the first column.</source>
        <translation>Geben Sie für jedes Foto eine Pose an, in der Reihenfolge der Namen, oder nennen Sie die Fotos in der ersten Spalte.</translation>
    </message>
    <message>
        <source>{0} names none of the photographs.</source>
        <translation>{0} nennt keines der Fotos.</translation>
    </message>
    <message>
        <source>Name them as they are called, as {0}.</source>
        <translation>Nennen Sie sie, wie sie heißen, etwa {0}.</translation>
    </message>
    <message>
        <source>{0} holds no poses.</source>
        <translation>{0} enthält keine Posen.</translation>
    </message>
    <message>
        <source>{0} is {1} ms {2} than {3}.</source>
        <translation>{0} ist {1} ms {2} als {3}.</translation>
    </message>
    <message>
        <source>later</source>
        <translation>später</translation>
    </message>
    <message>
        <source>earlier</source>
        <translation>früher</translation>
    </message>
    <message>
        <source>Photographs of {0} cameras: {1}.</source>
        <translation>Fotos von {0} Kameras: {1}.</translation>
    </message>
    <message>
        <source>Paired by their {0}: {1} of several cameras, the first {2}.</source>
        <translation>Zugeordnet nach {0}: {1} mehrerer Kameras, der erste {2}.</translation>
    </message>
    <message>
        <source>before the place {0}</source>
        <translation>vor dem Ort {0}</translation>
    </message>
    <message>
        <source>The order is shifted: each pose stands {0}, and was used for the photograph that it fits.</source>
        <translation>Die Reihenfolge ist verschoben: Jede Pose steht {0} und wurde für das Foto genommen, zu dem sie passt.</translation>
    </message>
    <message>
        <source>one line early</source>
        <translation>eine Zeile zu früh</translation>
    </message>
    <message>
        <source>one line late</source>
        <translation>eine Zeile zu spät</translation>
    </message>
    <message>
        <source>Leave it out {0}.</source>
        <translation>Lassen Sie es {0} aus.</translation>
    </message>
    <message>
        <source>below</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>names</source>
        <translation>Namen</translation>
    </message>
    <message>
        <source>numbers</source>
        <translation>Nummern</translation>
    </message>
    <message>
        <source>times, which are at most {0} ms apart</source>
        <translation>Zeiten, die höchstens {0} ms auseinanderliegen</translation>
    </message>
    <message>
        <source>1 instant</source>
        <translation>1 Zeitpunkt</translation>
    </message>
    <message>
        <source>{0} instants</source>
        <translation>{0} Zeitpunkte</translation>
    </message>
    <message>
        <source>Without a partner: {0}.</source>
        <translation>Ohne Partner: {0}.</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px.</source>
        <translation>{0} Kameras, {1}: Zusammen lassen sie {2} px übrig, jede allein {3} px.</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px, {4} times less.</source>
        <translation>{0} Kameras, {1}: Zusammen lassen sie {2} px übrig, jede allein {3} px, {4}-mal weniger.</translation>
    </message>
    <message>
        <source>They agree.</source>
        <translation>Sie stimmen überein.</translation>
    </message>
    <message>
        <source>The instants disagree.</source>
        <translation>Die Zeitpunkte widersprechen sich.</translation>
    </message>
    <message>
        <source>Single instants have {0} mm from where most have it beside {1}; the corners&apos; noise explains {2} mm.</source>
        <translation>Einzelne Zeitpunkte haben {0} mm von dort, wo die meisten sie neben {1} haben; das Rauschen der Ecken erklärt {2} mm.</translation>
    </message>
    <message>
        <source>Photographs of one instant were not taken at quite the same moment, or the board bends in the hand.</source>
        <translation>Die Fotos eines Zeitpunkts wurden nicht ganz gleichzeitig aufgenommen, oder das Brett biegt sich in der Hand.</translation>
    </message>
    <message>
        <source>Each ± counts it: put the board down for each picture, or trigger the cameras together.</source>
        <translation>Jedes ± zählt es mit: Stellen Sie das Brett für jedes Bild ab, oder lösen Sie die Kameras gemeinsam aus.</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} earlier: nothing above holds.</source>
        <translation>Die Fotos von {0} gehören zu denen von {1}, {2} früher: Nichts hier gilt.</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} later: nothing above holds.</source>
        <translation>Die Fotos von {0} gehören zu denen von {1}, {2} später: Nichts hier gilt.</translation>
    </message>
    <message>
        <source>Pair them so.</source>
        <translation>Ordnen Sie sie so zu.</translation>
    </message>
    <message>
        <source>Exchanged with those of {0}: {1}.</source>
        <translation>Vertauscht mit denen von {0}: {1}.</translation>
    </message>
    <message>
        <source>They are left out; give them back their names.</source>
        <translation>Sie sind ausgelassen; geben Sie ihnen ihre Namen zurück.</translation>
    </message>
    <message>
        <source>The squares were counted {0} times as long as in the others in {1}, and the photographs of {2} beside them.</source>
        <translation>In {1} und den Fotos von {2} daneben gelten die Quadrate als {0}-mal so lang wie in den anderen.</translation>
    </message>
    <message>
        <source>They are left out: is that another board, or another --square?</source>
        <translation>Sie sind ausgelassen: Ist das ein anderes Brett, oder eine andere Quadratseite?</translation>
    </message>
    <message>
        <source>{0} stands {1} mm otherwise beside {2} from {3} on.</source>
        <translation>{0} steht ab {3} um {1} mm anders neben {2}.</translation>
    </message>
    <message>
        <source>Calibrate the photographs before and after it by themselves.</source>
        <translation>Kalibrieren Sie die Fotos davor und danach für sich.</translation>
    </message>
    <message>
        <source>The boards stand {0} mm otherwise to each other from {1} on.</source>
        <translation>Die Bretter stehen ab {1} um {0} mm anders zueinander.</translation>
    </message>
    <message>
        <source>Fasten them, or calibrate the photographs before and after it by themselves.</source>
        <translation>Befestigen Sie sie, oder kalibrieren Sie die Fotos davor und danach für sich.</translation>
    </message>
    <message>
        <source>The focal length of {0} is {1} times as long from {2} on: it was refocused or zoomed.</source>
        <translation>Die Brennweite von {0} ist ab {2} {1}-mal so lang: Es wurde neu fokussiert oder gezoomt.</translation>
    </message>
    <message>
        <source>Left out, as the board is elsewhere than in the other cameras&apos; photographs of the instant: {0}.</source>
        <translation>Ausgelassen, da das Brett anderswo ist als in den Fotos der anderen Kameras zu diesem Zeitpunkt: {0}.</translation>
    </message>
    <message>
        <source>Were they taken at another instant?</source>
        <translation>Wurden sie zu einem anderen Zeitpunkt aufgenommen?</translation>
    </message>
    <message>
        <source>Those that agree least with the other cameras: {0}.</source>
        <translation>Am wenigsten stimmen mit den anderen Kameras überein: {0}.</translation>
    </message>
    <message>
        <source>Counted from another end of the board, and turned back: {0}.</source>
        <translation>Von einem anderen Ende des Bretts gezählt und zurückgedreht: {0}.</translation>
    </message>
    <message>
        <source>Where {0} stands beside {1} is open: no two cameras saw them at one instant.</source>
        <translation>Wo {0} neben {1} steht, ist offen: Keine zwei Kameras sahen sie zu einem Zeitpunkt.</translation>
    </message>
    <message>
        <source>Nothing else depends on it.</source>
        <translation>Nichts anderes hängt davon ab.</translation>
    </message>
    <message>
        <source>{0} deviates from its drawing by {1} mm rms, at most {2} mm.</source>
        <translation>{0} weicht um {1} mm (RMS) von der Zeichnung ab, höchstens um {2} mm.</translation>
    </message>
    <message>
        <source>board {0}</source>
        <translation>Brett {0}</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>Brett {0}</translation>
    </message>
    <message>
        <source>The board</source>
        <translation>Das Brett</translation>
    </message>
    <message>
        <source>The board moved while the cameras&apos; clocks did not agree: with one offset in time for each camera they leave {0} px.</source>
        <translation>Das Brett bewegte sich, während die Uhren der Kameras nicht übereinstimmten: Mit einem Zeitversatz je Kamera lassen sie {0} px übrig.</translation>
    </message>
    <message>
        <source>--offsets estimates these.</source>
        <translation>In der Einrichtung lässt er sich schätzen.</translation>
    </message>
    <message>
        <source>The kind or the size of {0} is not stated.</source>
        <translation>Art oder Größe von {0} ist nicht angegeben.</translation>
    </message>
    <message>
        <source>State both of each board (--target and --board on the command line).</source>
        <translation>Geben Sie beides für jedes Brett an.</translation>
    </message>
    <message>
        <source>Nothing is stated of {0} that tells it from the other boards.</source>
        <translation>Nichts ist von {0} angegeben, das es von den anderen Brettern unterscheidet.</translation>
    </message>
    <message>
        <source>Several boards have markers or tags: state --target and --board of each, and the --dictionary of a ChArUco board, the --family of one with AprilTags.</source>
        <translation>Mehrere Bretter haben Marker oder Tags: Geben Sie Art und Größe jedes Bretts an, dazu das Wörterbuch eines ChArUco-Bretts oder die Familie eines mit AprilTags.</translation>
    </message>
    <message>
        <source>The markers {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>Die Marker {0} bis {1} von {2} sind auf {3} und auf {4}: Fotos unterscheiden die Bretter nicht.</translation>
    </message>
    <message>
        <source>The tags {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>Die Tags {0} bis {1} von {2} sind auf {3} und auf {4}: Fotos unterscheiden die Bretter nicht.</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that never see the board together: {1}.</source>
        <translation>Die Kameras zerfallen in {0} Gruppen, die das Brett nie zusammen sehen: {1}.</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that nothing joins: {1}.</source>
        <translation>Die Kameras zerfallen in {0} Gruppen, die nichts verbindet: {1}.</translation>
    </message>
    <message>
        <source>{0} shows no board of {1} in any photograph, and {2} does.</source>
        <translation>{0} zeigt auf keinem Foto ein Brett von {1}, {2} dagegen schon.</translation>
    </message>
    <message>
        <source>A rig takes one board before all cameras: photograph the same one, or leave out the camera that saw another.</source>
        <translation>Ein Rig braucht ein Brett vor allen Kameras: Fotografieren Sie dasselbe, oder lassen Sie die Kamera aus, die ein anderes sah.</translation>
    </message>
</context>
<context>
    <name>SeriesDialog</name>
    <message>
        <source>Series of calibrations</source>
        <translation>Reihe von Kalibrierungen</translation>
    </message>
    <message>
        <source>&amp;Add results…</source>
        <translation>Ergebnisse &amp;hinzufügen…</translation>
    </message>
    <message>
        <source>The quantity that varies</source>
        <translation>Die Größe, die sich ändert</translation>
    </message>
    <message>
        <source>zoom</source>
        <translation>Zoom</translation>
    </message>
    <message>
        <source>focus</source>
        <translation>Fokus</translation>
    </message>
    <message>
        <source>temperature</source>
        <translation>Temperatur</translation>
    </message>
    <message>
        <source>date</source>
        <translation>Datum</translation>
    </message>
    <message>
        <source>&amp;Table of values…</source>
        <translation>&amp;Wertetabelle…</translation>
    </message>
    <message>
        <source>A CSV file with the columns file,value; temperatures in °C. Without one focal lengths and dates are read from the photographs.</source>
        <translation>Eine CSV-Datei mit den Spalten file,value; Temperaturen in °C. Ohne sie werden Brennweiten und Daten aus den Fotos gelesen.</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Value at which the camera is shown</source>
        <translation>Wert, bei dem die Kamera gezeigt wird</translation>
    </message>
    <message>
        <source>Format</source>
        <translation>Format</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>&amp;Exportieren…</translation>
    </message>
    <message>
        <source>Add the result.json of each setting of one camera: three or more.</source>
        <translation>Die result.json jeder Einstellung einer Kamera hinzufügen: drei oder mehr.</translation>
    </message>
    <message>
        <source>by</source>
        <translation>nach</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>Ergebnisse</translation>
    </message>
    <message>
        <source>Camera at a value</source>
        <translation>Kamera bei einem Wert</translation>
    </message>
    <message>
        <source>Camera at</source>
        <translation>Kamera bei</translation>
    </message>
    <message>
        <source>as</source>
        <translation>als</translation>
    </message>
    <message>
        <source>Results (*.json)</source>
        <translation>Ergebnisse (*.json)</translation>
    </message>
    <message>
        <source>Table of values</source>
        <translation>Wertetabelle</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tabellen (*.csv)</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>rechnet…</translation>
    </message>
    <message>
        <source>Fitting the series</source>
        <translation>Reihe anpassen</translation>
    </message>
    <message>
        <source>From {0} to {1}; empty to write a profile of all focal lengths</source>
        <translation>Von {0} bis {1}; leer schreibt ein Profil aller Brennweiten</translation>
    </message>
    <message>
        <source>File</source>
        <translation>Datei</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>From the first</source>
        <translation>Zur ersten</translation>
    </message>
    <message>
        <source>Difference from the first camera after a rotation, rms</source>
        <translation>Unterschied zur ersten Kamera nach einer Drehung, RMS</translation>
    </message>
    <message>
        <source>Explained</source>
        <translation>Erklärt</translation>
    </message>
    <message>
        <source>Difference that the calibrations&apos; uncertainties explain</source>
        <translation>Unterschied, den die Unsicherheiten der Kalibrierungen erklären</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>Of a difference as large as this one if the camera has not changed</source>
        <translation>Eines so großen Unterschieds, wenn die Kamera sich nicht geändert hat</translation>
    </message>
    <message>
        <source>Changed</source>
        <translation>Geändert</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>Benutzt</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>ja</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>Reason</source>
        <translation>Grund</translation>
    </message>
    <message>
        <source>no</source>
        <translation>nein</translation>
    </message>
    <message>
        <source>{0} is no value of {1}.</source>
        <translation>{0} ist kein Wert von {1}.</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exportieren</translation>
    </message>
    <message>
        <source>Saved as {0}. {1}</source>
        <translation>Gespeichert als {0}. {1}</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>{0} schreiben</translation>
    </message>
</context>
<context>
    <name>Session</name>
    <message>
        <source>Out of date, as images or board have changed: calibrate again.</source>
        <translation>Veraltet, da Bilder oder Brett sich geändert haben: neu kalibrieren.</translation>
    </message>
    <message>
        <source>Out of date, as settings have changed: calibrate again.</source>
        <translation>Veraltet, da Einstellungen sich geändert haben: neu kalibrieren.</translation>
    </message>
</context>
<context>
    <name>SettingsPanel</name>
    <message>
        <source>&amp;Leave outliers out</source>
        <translation>&amp;Ausreißer weglassen</translation>
    </message>
    <message>
        <source>Remove corners and views that do not fit from the images, as by hand: undo brings them back. The result names them.</source>
        <translation>Ecken und Ansichten, die nicht passen, wie von Hand aus den Bildern nehmen: Rückgängig bringt sie wieder. Das Ergebnis nennt sie.</translation>
    </message>
    <message>
        <source>&amp;Weigh views by their noise</source>
        <translation>Ansichten nach &amp;Rauschen wichten</translation>
    </message>
    <message>
        <source>Make the camera bette&amp;r</source>
        <translation>Die Kamera &amp;verbessern</translation>
    </message>
    <message>
        <source>Carry out what needs no new photograph and makes errors smaller by a fifth or more: another lens model or board shape where these are automatic, and leaving out corners and views that do not fit. Undo goes back through it.</source>
        <translation>Tun, was kein neues Foto braucht und Fehler um ein Fünftel oder mehr verkleinert: ein anderes Linsenmodell oder eine andere Brettform, wo diese automatisch sind, und Weglassen von Ecken und Ansichten, die nicht passen. Rückgängig geht hindurch zurück.</translation>
    </message>
    <message>
        <source>Search a&amp;gain with the camera</source>
        <translation>Mit der Kamera &amp;neu suchen</translation>
    </message>
    <message>
        <source>Once the camera is known, search the images without a board and the boards found in part again, and calibrate from what that gains.</source>
        <translation>Ist die Kamera bekannt, werden Bilder ohne Brett und teils gefundene Bretter neu abgesucht, und aus dem Gewinn wird kalibriert.</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>Neu kalibrieren</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation>automatisch</translation>
    </message>
    <message>
        <source>The paper&apos;s model, unless views that the models have not seen demand another. The result says why. Slower.</source>
        <translation>Das Modell des Aufsatzes, wenn nicht Ansichten, die die Modelle nicht gesehen haben, ein anderes verlangen. Das Ergebnis sagt, warum. Langsamer.</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>Linsenmodell</translation>
    </message>
    <message>
        <source>Values of held parameters</source>
        <translation>Werte fester Parameter</translation>
    </message>
    <message>
        <source>Parameters that are held at values of their own, as fx=650, p1=0. Of the others that are held coefficients are 0, the centre is the image&apos;s and focal lengths are those of the closed form.</source>
        <translation>Parameter, die auf eigenen Werten festgehalten werden, wie fx=650, p1=0. Von den anderen festen sind Koeffizienten 0, die Mitte ist die des Bildes, und Brennweiten sind die der geschlossenen Lösung.</translation>
    </message>
    <message>
        <source>&amp;Minimise</source>
        <translation>&amp;Minimieren</translation>
    </message>
    <message>
        <source>Held at</source>
        <translation>Fest bei</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Kamera</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Verfahren</translation>
    </message>
    <message>
        <source>Estimate</source>
        <translation>Schätzen</translation>
    </message>
    <message>
        <source>The chosen method has nothing else to minimise.</source>
        <translation>Das gewählte Verfahren hat nichts anderes zu minimieren.</translation>
    </message>
    <message>
        <source>The error in the image takes any board.</source>
        <translation>Der Fehler im Bild nimmt jedes Brett.</translation>
    </message>
    <message>
        <source>The chosen method takes every board as it is drawn.</source>
        <translation>Das gewählte Verfahren nimmt jedes Brett, wie es gezeichnet ist.</translation>
    </message>
    <message>
        <source>Only the error in the image takes weights.</source>
        <translation>Nur der Fehler im Bild nimmt Gewichte.</translation>
    </message>
    <message>
        <source>Poor views then spoil less. Best with an estimated shape of the board, which would else pass for noise.</source>
        <translation>Schlechte Ansichten schaden dann weniger. Am besten mit geschätzter Brettform, die sonst als Rauschen gälte.</translation>
    </message>
    <message>
        <source>The chosen method takes all corners as equally good.</source>
        <translation>Das gewählte Verfahren nimmt alle Ecken als gleich gut.</translation>
    </message>
    <message>
        <source>The chosen method has its own lens model: what its authors corrected.</source>
        <translation>Das gewählte Verfahren hat sein eigenes Linsenmodell: was seine Autoren korrigierten.</translation>
    </message>
    <message>
        <source>The formulation of the paper has its own lens model, with a radius in pixels.</source>
        <translation>Die Formulierung des Aufsatzes hat ihr eigenes Linsenmodell, mit einem Radius in Pixeln.</translation>
    </message>
    <message>
        <source>How the lens bends what a pinhole would image; the result is of it.</source>
        <translation>Wie die Linse biegt, was ein Loch abbildete; das Ergebnis ist von ihr.</translation>
    </message>
    <message>
        <source>Estimate {0}; otherwise it is held, coefficients at 0.</source>
        <translation>{0} schätzen; sonst ist es fest, Koeffizienten bei 0.</translation>
    </message>
    <message>
        <source>The chosen method cannot estimate {0}.</source>
        <translation>Das gewählte Verfahren kann {0} nicht schätzen.</translation>
    </message>
    <message>
        <source>Calibration settings</source>
        <translation>Kalibriereinstellungen</translation>
    </message>
</context>
<context>
    <name>SetupSheet</name>
    <message>
        <source>Board</source>
        <translation>Brett</translation>
    </message>
    <message>
        <source>What is photographed</source>
        <translation>Was fotografiert wird</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Linse</translation>
    </message>
    <message>
        <source>Which model describes the lens</source>
        <translation>Welches Modell die Linse beschreibt</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>What is demanded of the camera</source>
        <translation>Was von der Kamera gefordert ist</translation>
    </message>
    <message>
        <source>For experts</source>
        <translation>Für Fachleute</translation>
    </message>
    <message>
        <source>How to calibrate</source>
        <translation>Wie kalibriert wird</translation>
    </message>
</context>
<context>
    <name>SourceList</name>
    <message>
        <source>&amp;Another camera</source>
        <translation>&amp;Noch eine Kamera</translation>
    </message>
    <message>
        <source>&amp;Remove</source>
        <translation>&amp;Entfernen</translation>
    </message>
    <message>
        <source>Several cameras that stand fast to each other take each picture together</source>
        <translation>Mehrere Kameras, die fest zueinander stehen, nehmen jedes Bild gemeinsam auf</translation>
    </message>
    <message>
        <source>Camera {0}</source>
        <translation>Kamera {0}</translation>
    </message>
    <message>
        <source>A camera at this computer, or the address of one in the network (rtsp://…, http://…), or the folder that a camera&apos;s program fills</source>
        <translation type="unfinished">Eine Kamera an diesem Rechner, die Adresse einer im Netz (rtsp://…, http://…) oder der Ordner, den das Programm einer Kamera füllt</translation>
    </message>
    <message>
        <source>camera {0}</source>
        <translation type="unfinished">Kamera {0}</translation>
    </message>
</context>
<context>
    <name>SquareRow</name>
    <message>
        <source>Only lengths depend on it, no pixel does. Until it is confirmed, every length holds on this condition.</source>
        <translation>Nur Längen hängen davon ab, kein Pixel. Bis sie bestätigt ist, gilt jede Länge unter dieser Bedingung.</translation>
    </message>
    <message>
        <source>Confirm</source>
        <translation>Bestätigen</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>Größe der Quadrate</translation>
    </message>
    <message>
        <source>Confirm the size of squares</source>
        <translation>Größe der Quadrate bestätigen</translation>
    </message>
    <message>
        <source>Lengths hold: you have confirmed {0:g} {1}.</source>
        <translation>Längen gelten: {0:g} {1} sind bestätigt.</translation>
    </message>
    <message>
        <source>How far apart are the circles? {2}, {0} × {1}.</source>
        <translation>Wie weit sind die Kreise auseinander? {2}, {0} × {1}.</translation>
    </message>
    <message>
        <source>How far apart are the circles? The board is being counted.</source>
        <translation>Wie weit sind die Kreise auseinander? Das Brett wird gezählt.</translation>
    </message>
    <message>
        <source>How far apart are the circles? Their number is not known: state it in the Set-up.</source>
        <translation>Wie weit sind die Kreise auseinander? Ihre Zahl ist unbekannt: in der Einrichtung angeben.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? {2}, {0} × {1} corners.</source>
        <translation>Wie lang sind die Seiten der Marken? {2}, {0} × {1} Ecken.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? The board is being counted.</source>
        <translation>Wie lang sind die Seiten der Marken? Das Brett wird gezählt.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? Their number is not known: state it in the Set-up.</source>
        <translation>Wie lang sind die Seiten der Marken? Ihre Zahl ist unbekannt: in der Einrichtung angeben.</translation>
    </message>
    <message>
        <source>How long are the squares? {2}, {0} × {1} inner corners.</source>
        <translation>Wie lang sind die Quadrate? {2}, {0} × {1} innere Ecken.</translation>
    </message>
    <message>
        <source>How long are the squares? The board is being counted.</source>
        <translation>Wie lang sind die Quadrate? Das Brett wird gezählt.</translation>
    </message>
    <message>
        <source>How long are the squares? Their number is not known: state it in the Set-up.</source>
        <translation>Wie lang sind die Quadrate? Ihre Zahl ist unbekannt: in der Einrichtung angeben.</translation>
    </message>
    <message>
        <source>Distance of circles</source>
        <translation>Abstand der Kreise</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>Seite einer Marke</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Seite eines Quadrats</translation>
    </message>
    <message>
        <source>Confirm {0:g} {1}</source>
        <translation>{0:g} {1} bestätigen</translation>
    </message>
    <message>
        <source>This length is confirmed already; state another one first.</source>
        <translation>Diese Länge ist schon bestätigt; erst eine andere angeben.</translation>
    </message>
</context>
<context>
    <name>StageOnePanel</name>
    <message>
        <source>Stage I</source>
        <translation>Stufe I</translation>
    </message>
    <message>
        <source>What each view says of the camera by itself: the paper&apos;s first stage.</source>
        <translation>Was jede Ansicht für sich von der Kamera sagt: die erste Stufe des Aufsatzes.</translation>
    </message>
    <message>
        <source>aspect ratio r</source>
        <translation>Seitenverhältnis r</translation>
    </message>
    <message>
        <source>g(r)</source>
        <translation>g(r)</translation>
    </message>
    <message>
        <source>The cosines&apos; equation of the selected view: where it is zero, r = fy / fx.
It has no value where the view&apos;s tilt does not determine it.</source>
        <translation>Die Kosinusgleichung der gewählten Ansicht: wo sie null ist, r = fy / fx.
Sie hat keinen Wert, wo die Neigung der Ansicht ihn nicht bestimmt.</translation>
    </message>
    <message>
        <source>view</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>aspect ratio fy / fx</source>
        <translation>Verhältnis fy / fx</translation>
    </message>
    <message>
        <source>The root of each view. Views near fronto-parallel, or tilted about one axis,
give none or a poor one: Stage II does not depend on them.</source>
        <translation>Die Nullstelle jeder Ansicht. Ansichten fast von vorn oder um eine Achse geneigt
geben keine oder eine schlechte: Stufe II hängt nicht davon ab.</translation>
    </message>
    <message>
        <source>No view determines its aspect ratio.</source>
        <translation>Keine Ansicht bestimmt ihr Seitenverhältnis.</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r = {1:.4f}</source>
        <translation>{0}&lt;br&gt;r = {1:.4f}</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r is not determined</source>
        <translation>{0}&lt;br&gt;r ist unbestimmt</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Principal point right of the array&apos;s centre</source>
        <translation>Bildhauptpunkt rechts der Sensormitte</translation>
    </message>
    <message>
        <source>Principal point above the centre</source>
        <translation>Bildhauptpunkt über der Mitte</translation>
    </message>
    <message>
        <source>First radial coefficient</source>
        <translation>Erster radialer Koeffizient</translation>
    </message>
    <message>
        <source>Aspect ratio: root of the cosines&apos; equation</source>
        <translation>Seitenverhältnis: Nullstelle der Kosinusgleichung</translation>
    </message>
    <message>
        <source>Focal length</source>
        <translation>Brennweite</translation>
    </message>
    <message>
        <source>Iterations of Levenberg-Marquardt</source>
        <translation>Iterationen nach Levenberg-Marquardt</translation>
    </message>
    <message>
        <source>px′</source>
        <translation>px′</translation>
    </message>
    <message>
        <source>Residual on the reference plane; px′ are its pixels, 30 to a square</source>
        <translation>Residuum auf der Referenzebene; px′ sind deren Pixel, 30 je Quadrat</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate, from RMS, corners and 11 unknowns</source>
        <translation>Standardabweichung einer Koordinate, aus RMS, Ecken und 11 Unbekannten</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation type="unfinished">Ecken</translation>
    </message>
    <message>
        <source>Number of the view&apos;s corners</source>
        <translation>Anzahl der Ecken der Aufnahme</translation>
    </message>
    <message>
        <source>no convergence</source>
        <translation>nicht konvergiert</translation>
    </message>
    <message>
        <source>Far from the other views: {0}</source>
        <translation>Fern von den anderen Ansichten: {0}</translation>
    </message>
</context>
<context>
    <name>SyntheticPanel</name>
    <message>
        <source>Synthetic check</source>
        <translation>Synthetische Probe</translation>
    </message>
    <message>
        <source>Whether the method finds this camera again.</source>
        <translation>Ob das Verfahren diese Kamera wiederfindet.</translation>
    </message>
    <message>
        <source>&amp;Render and calibrate</source>
        <translation>&amp;Rechnen und kalibrieren</translation>
    </message>
    <message>
        <source>Renders every view from the result, finds the corners again, adds the noise that
was found and calibrates: what must come back is known exactly.</source>
        <translation>Rechnet die Ansichten aus dem Ergebnis, findet die Ecken wieder, fügt das gefundene
Rauschen hinzu und kalibriert: was herauskommen muss, ist genau bekannt.</translation>
    </message>
    <message>
        <source>Rendering the views and searching them…</source>
        <translation>Die Ansichten werden gerechnet und abgesucht…</translation>
    </message>
    <message>
        <source>real</source>
        <translation>echt</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>synthetisch</translation>
    </message>
    <message>
        <source>Table</source>
        <translation>Tabelle</translation>
    </message>
    <message>
        <source>Images</source>
        <translation>Bilder</translation>
    </message>
    <message>
        <source>Poses</source>
        <translation>Lagen</translation>
    </message>
    <message>
        <source>Residuals</source>
        <translation>Residuen</translation>
    </message>
    <message>
        <source>Histograms</source>
        <translation>Histogramme</translation>
    </message>
    <message>
        <source>Table 3 of the paper</source>
        <translation>Tabelle 3 des Aufsatzes</translation>
    </message>
    <message>
        <source>The board&apos;s pattern is not known, so its views cannot be rendered.</source>
        <translation>Das Muster des Bretts ist unbekannt, daher lassen sich seine Ansichten nicht rechnen.</translation>
    </message>
    <message>
        <source>Would the method find this camera again, if it were just so?</source>
        <translation>Fände das Verfahren diese Kamera wieder, wenn sie genau so wäre?</translation>
    </message>
    <message>
        <source>{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, real images {4:.3f} ± {5:.3f}.</source>
        <translation>{0} von {1} Ansichten wiedergefunden. e′ = {2:.4f} ± {3:.4f} Referenz-px, echte Bilder {4:.3f} ± {5:.3f}.</translation>
    </message>
    <message>
        <source>Rendering {0}</source>
        <translation>{0} rechnen</translation>
    </message>
</context>
<context>
    <name>Table</name>
    <message>
        <source>Table</source>
        <translation>Tabelle</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>Kopieren</translation>
    </message>
    <message>
        <source>Save as CSV…</source>
        <translation>Als CSV speichern…</translation>
    </message>
    <message>
        <source>Table of {0}</source>
        <translation>Tabelle von {0}</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>Tabelle speichern</translation>
    </message>
    <message>
        <source>Comma-separated values (*.csv)</source>
        <translation>Kommagetrennte Werte (*.csv)</translation>
    </message>
</context>
<context>
    <name>TakenStrip</name>
    <message>
        <source>Pictures taken</source>
        <translation>Aufgenommene Bilder</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>&amp;Zurücknehmen</translation>
    </message>
    <message>
        <source>{0} · put aside</source>
        <translation>{0} · zurückgelegt</translation>
    </message>
    <message>
        <source>{0}: a camera calibrated without it is checked with it as well</source>
        <translation>{0}: Eine ohne dieses Bild kalibrierte Kamera wird damit auch geprüft</translation>
    </message>
    <message>
        <source>&amp;Take again</source>
        <translation>Neu &amp;aufnehmen</translation>
    </message>
</context>
<context>
    <name>Tour</name>
    <message>
        <source>Leave</source>
        <translation>Verlassen</translation>
    </message>
    <message>
        <source>Your photographs</source>
        <translation>Ihre Fotos</translation>
    </message>
    <message>
        <source>The bar below each is how far its corners are from where the camera puts them. Drag the dashed line, and leave out what is above it.</source>
        <translation>Der Balken unter jedem zeigt, wie weit seine Ecken von dort sind, wohin die Kamera sie setzt. Die gestrichelte Linie ziehen und weglassen, was darüber liegt.</translation>
    </message>
    <message>
        <source>One photograph</source>
        <translation>Ein Foto</translation>
    </message>
    <message>
        <source>The corners that were found. Where a board is missed, press Mark and click on its four outermost corners.</source>
        <translation>Die gefundenen Ecken. Wo ein Brett fehlt, auf Markieren drücken und seine vier äußersten Ecken anklicken.</translation>
    </message>
    <message>
        <source>The verdict</source>
        <translation>Das Urteil</translation>
    </message>
    <message>
        <source>Whether the camera can be used, and how far off a point is in the image: at the centre, at the edge, at worst, and in mm at your distance.</source>
        <translation>Ob die Kamera brauchbar ist, und wie weit ein Punkt im Bild danebenliegt: in der Mitte, am Rand, schlimmstens, und in mm in Ihrer Entfernung.</translation>
    </message>
    <message>
        <source>What was done</source>
        <translation>Was getan wurde</translation>
    </message>
    <message>
        <source>Each step that made the camera better can be undone, or says why.</source>
        <translation>Jeder Schritt, der die Kamera verbessert hat, lässt sich zurücknehmen oder sagt, warum.</translation>
    </message>
    <message>
        <source>Look closer</source>
        <translation>Genauer hinsehen</translation>
    </message>
    <message>
        <source>Each mode fills the desk: the method step by step, the fit, the lens, the board, and images without distortion.</source>
        <translation>Jede Ansicht füllt den Tisch: das Verfahren Schritt für Schritt, die Anpassung, die Linse, das Brett und Bilder ohne Verzeichnung.</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>Einrichtung</translation>
    </message>
    <message>
        <source>The board, the lens, and limits for PASS or FAIL.</source>
        <translation>Das Brett, die Linse und Grenzen für PASS oder FAIL.</translation>
    </message>
    <message>
        <source>Take it with you</source>
        <translation>Mitnehmen</translation>
    </message>
    <message>
        <source>Export writes the camera for other programs, Report a page for people.</source>
        <translation>Export schreibt die Kamera für andere Programme, Bericht eine Seite für Menschen.</translation>
    </message>
    <message>
        <source>Still good?</source>
        <translation>Noch gut?</translation>
    </message>
    <message>
        <source>Months later, drop a few new photographs on this side: they check the camera and change nothing.</source>
        <translation>Monate später einige neue Fotos auf dieser Seite ablegen: sie prüfen die Kamera und ändern nichts.</translation>
    </message>
    <message>
        <source>{0} of {1}</source>
        <translation>{0} von {1}</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>Weiter</translation>
    </message>
    <message>
        <source>Done</source>
        <translation>Fertig</translation>
    </message>
</context>
<context>
    <name>UncertaintyPanel</name>
    <message>
        <source>Uncertainty</source>
        <translation>Unsicherheit</translation>
    </message>
    <message>
        <source>How well it is known where points are imaged.</source>
        <translation>Wie gut bekannt ist, wo Punkte abgebildet werden.</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>far away</source>
        <translation>weit weg</translation>
    </message>
    <message>
        <source>Of the points that the camera will look at; 0 for points far away.</source>
        <translation>Der Punkte, die die Kamera ansehen wird; 0 für weit entfernte.</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>The uncertainty that you can live with: the red line goes around it.</source>
        <translation>Die Unsicherheit, mit der Sie leben können: die rote Linie umgibt sie.</translation>
    </message>
    <message>
        <source>P&amp;oints</source>
        <translation>P&amp;unkte</translation>
    </message>
    <message>
        <source>Limi&amp;t</source>
        <translation>&amp;Grenze</translation>
    </message>
    <message>
        <source>one σ, worst direction [px]</source>
        <translation>ein σ, schlechteste Richtung [px]</translation>
    </message>
    <message>
        <source>A point of the scene is imaged this far from where the calibration says (1σ).
What turning and shifting the camera would undo is taken out.
It is what the calibration says of itself. The verdict&apos;s error may be another:
where the remedy of a finding was tried, it is measured against the camera that
the remedy gives. Where there are no corners it adds how far another lens model
goes apart from this one that fits as well.</source>
        <translation>So weit (1σ) von dort, wo die Kalibrierung es sagt, wird ein Punkt der Szene abgebildet.
Was Drehen und Verschieben der Kamera aufhöbe, ist herausgenommen.
Es ist, was die Kalibrierung von sich selbst sagt. Der Fehler im Urteil kann ein anderer sein:
wo die Abhilfe eines Befunds versucht wurde, ist er gegen die Kamera gemessen, die
diese gibt. Wo keine Ecken sind, zählt er dazu, wie weit ein anderes Linsenmodell
davon abweicht, das ebenso gut passt.</translation>
    </message>
    <message>
        <source>Working…</source>
        <translation>Rechnet…</translation>
    </message>
    <message>
        <source>Propagating the uncertainty</source>
        <translation>Unsicherheit fortpflanzen</translation>
    </message>
    <message>
        <source> (inside the red line)</source>
        <translation> (innerhalb der roten Linie)</translation>
    </message>
    <message>
        <source>By this lens model points {0} are imaged to {1} px at the centre, {2} px in the median, {3} px at worst (1σ). {4:.0f} % of the image is known to {5:g} px or better{6}.</source>
        <translation>Nach diesem Linsenmodell werden Punkte {0} auf {1} px in der Mitte abgebildet, {2} px im Median, {3} px schlimmstens (1σ). {4:.0f} % des Bildes sind auf {5:g} px oder besser bekannt{6}.</translation>
    </message>
    <message>
        <source>{0:g} mm away</source>
        <translation>in {0:g} mm Entfernung</translation>
    </message>
    <message>
        <source> The brightest colour is {0} px or more.</source>
        <translation> Die hellste Farbe ist {0} px oder mehr.</translation>
    </message>
    <message>
        <source>Point at the map to read it.</source>
        <translation>Zum Ablesen auf die Karte zeigen.</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, in all directions {3:.3f} px</source>
        <translation>u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, in allen Richtungen {3:.3f} px</translation>
    </message>
</context>
<context>
    <name>UndistortPanel</name>
    <message>
        <source>Undistort</source>
        <translation>Entzerren</translation>
    </message>
    <message>
        <source>An image without the lens&apos;s distortion, or rectified to the board.</source>
        <translation>Ein Bild ohne die Verzeichnung der Linse, oder auf das Brett rektifiziert.</translation>
    </message>
    <message>
        <source>Angle from the left edge of the new image to the right one</source>
        <translation>Winkel vom linken zum rechten Rand des neuen Bildes</translation>
    </message>
    <message>
        <source>Field of view in degrees</source>
        <translation>Bildwinkel in Grad</translation>
    </message>
    <message>
        <source>Save &amp;this…</source>
        <translation>&amp;Dieses speichern…</translation>
    </message>
    <message>
        <source>&amp;Save all…</source>
        <translation>&amp;Alle speichern…</translation>
    </message>
    <message>
        <source>Write the selected image as it is shown here into a folder</source>
        <translation>Das gewählte Bild, wie es hier zu sehen ist, in einen Ordner schreiben</translation>
    </message>
    <message>
        <source>Write all images like this into a folder, those that were left out as well</source>
        <translation>Alle Bilder so in einen Ordner schreiben, auch die weggelassenen</translation>
    </message>
    <message>
        <source>as taken</source>
        <translation>wie aufgenommen</translation>
    </message>
    <message>
        <source>undistorted</source>
        <translation>entzerrt</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>Perspektivisch</translation>
    </message>
    <message>
        <source>Cylindrical</source>
        <translation>Zylindrisch</translation>
    </message>
    <message>
        <source>Equirectangular</source>
        <translation>Equirektangular</translation>
    </message>
    <message>
        <source>Stereographic</source>
        <translation>Stereographisch</translation>
    </message>
    <message>
        <source>Cube</source>
        <translation>Würfel</translation>
    </message>
    <message>
        <source>Rectified to the board</source>
        <translation>Auf das Brett rektifiziert</translation>
    </message>
    <message>
        <source>Perspective keeps straight lines straight, and shows less than 180°.
Cylindrical unrolls the horizon; upright lines stay straight.
Equirectangular is a map of longitude and latitude, for viewers of 360° images.
Stereographic is a wide view in which small things keep their shape.
Cube makes perspective images of 90° to all sides.
Rectified shows the board from straight above.</source>
        <translation>Perspektivisch lässt Geraden gerade und zeigt weniger als 180°.
Zylindrisch rollt den Horizont ab; Senkrechte bleiben gerade.
Equirektangular ist eine Karte von Länge und Breite, für Betrachter von 360°-Bildern.
Stereographisch ist ein weiter Blick, in dem Kleines seine Form behält.
Würfel macht perspektivische Bilder von 90° nach allen Seiten.
Rektifiziert zeigt das Brett genau von oben.</translation>
    </message>
    <message>
        <source>What to make of the image</source>
        <translation>Was aus dem Bild wird</translation>
    </message>
    <message>
        <source>All pixels</source>
        <translation>Alle Pixel</translation>
    </message>
    <message>
        <source>No black border</source>
        <translation>Kein schwarzer Rand</translation>
    </message>
    <message>
        <source>Same scale</source>
        <translation>Gleicher Maßstab</translation>
    </message>
    <message>
        <source>Field of view</source>
        <translation>Bildwinkel</translation>
    </message>
    <message>
        <source>All pixels keeps everything, with black beyond it; no black border cuts to a full rectangle;
same scale keeps the size of the middle; field of view shows an angle of your choice.</source>
        <translation>Alle Pixel behält alles, mit Schwarz darum; kein schwarzer Rand schneidet auf ein volles Rechteck;
gleicher Maßstab behält die Größe der Mitte; Bildwinkel zeigt einen Winkel Ihrer Wahl.</translation>
    </message>
    <message>
        <source>How much of the image to show</source>
        <translation>Wie viel vom Bild zu zeigen ist</translation>
    </message>
    <message>
        <source>{0}: working…</source>
        <translation>{0}: rechnet…</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>{0} entzerren</translation>
    </message>
    <message>
        <source>{0}: {1} × {2} px</source>
        <translation>{0}: {1} × {2} px</translation>
    </message>
</context>
<context>
    <name>VerdictBar</name>
    <message>
        <source>Remedy</source>
        <translation>Abhilfe</translation>
    </message>
    <message>
        <source>Judging the calibration</source>
        <translation>Kalibrierung beurteilen</translation>
    </message>
    <message>
        <source>SEARCHING CORNERS…</source>
        <translation>ECKEN WERDEN GESUCHT…</translation>
    </message>
    <message>
        <source>CALIBRATING…</source>
        <translation>KALIBRIERT…</translation>
    </message>
    <message>
        <source>NOT CALIBRATED</source>
        <translation>NICHT KALIBRIERT</translation>
    </message>
    <message>
        <source>KNOWN CAMERA</source>
        <translation>BEKANNTE KAMERA</translation>
    </message>
    <message>
        <source>FIRST FIT</source>
        <translation>ERSTE ANPASSUNG</translation>
    </message>
    <message>
        <source>JUDGING…</source>
        <translation>URTEILT…</translation>
    </message>
    <message>
        <source>Of {0} photographs. {1}</source>
        <translation>Von {0} Fotos. {1}</translation>
    </message>
    <message>
        <source>The new calibration is being made better, and judged.</source>
        <translation>Die neue Kalibrierung wird verbessert und beurteilt.</translation>
    </message>
    <message>
        <source>The new calibration is being judged: what makes it better is tried.</source>
        <translation>Die neue Kalibrierung wird beurteilt: was sie verbessert, wird versucht.</translation>
    </message>
    <message>
        <source>No photograph can be used: click one to see why.</source>
        <translation>Kein Foto ist zu gebrauchen: eines anklicken, um zu sehen, warum.</translation>
    </message>
    <message>
        <source>No board of the kind “{0}” was found: click a photograph to see why.</source>
        <translation>Kein Brett der Art „{0}“ wurde gefunden: ein Foto anklicken, um zu sehen, warum.</translation>
    </message>
    <message>
        <source>Mark the board in the photographs (M), or let them be searched: Set-up.</source>
        <translation>Das Brett in den Fotos markieren (M) oder sie absuchen lassen: Einrichtung.</translation>
    </message>
    <message>
        <source>How far the camera can be trusted is said here once it is calibrated.</source>
        <translation>Wie weit der Kamera zu trauen ist, steht hier, sobald sie kalibriert ist.</translation>
    </message>
    <message>
        <source>&amp;1 finding</source>
        <translation>&amp;1 Befund</translation>
    </message>
    <message>
        <source>{0} &amp;findings</source>
        <translation>{0} &amp;Befunde</translation>
    </message>
    <message>
        <source>List what is wrong, with the figures that show it</source>
        <translation>Auflisten, was nicht stimmt, mit den Zahlen dazu</translation>
    </message>
    <message>
        <source>Is it &amp;glass?</source>
        <translation>Ist es &amp;Glas?</translation>
    </message>
    <message>
        <source>Say what it brings to state that the board is of glass</source>
        <translation>Sagen, was die Angabe bringt, dass das Brett aus Glas ist</translation>
    </message>
    <message>
        <source>State a board of glass</source>
        <translation>Brett aus Glas angeben</translation>
    </message>
</context>
<context>
    <name>VerdictTexts</name>
    <message>
        <source>GOOD</source>
        <translation>GUT</translation>
    </message>
    <message>
        <source>USABLE</source>
        <translation>BRAUCHBAR</translation>
    </message>
    <message>
        <source>CAN BE {0}× BETTER</source>
        <translation>BIS {0}× BESSER</translation>
    </message>
    <message>
        <source>NOT USABLE</source>
        <translation>UNBRAUCHBAR</translation>
    </message>
    <message>
        <source>Error: unknown</source>
        <translation>Fehler: unbekannt</translation>
    </message>
    <message>
        <source>Error: centre {0}, among corners {1}, edge {2}, worst {3} px</source>
        <translation>Fehler: Mitte {0}, bei Ecken {1}, Rand {2}, größter {3} px</translation>
    </message>
    <message>
        <source>{0} mm at the edge, {1:.0f} mm away</source>
        <translation>{0} mm am Rand, in {1:.0f} mm</translation>
    </message>
    <message>
        <source>edge: {0} mm at {1} m</source>
        <translation>Rand: {0} mm in {1} m</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} circles</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px von {2:,} Kreisen</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} corners</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px von {2:,} Ecken</translation>
    </message>
    <message>
        <source>Estimate the board&apos;s shape</source>
        <translation>Form des Bretts schätzen</translation>
    </message>
    <message>
        <source>Take the lens model that fits</source>
        <translation>Passendes Modell nehmen</translation>
    </message>
    <message>
        <source>Leave these corners out</source>
        <translation>Diese Ecken weglassen</translation>
    </message>
    <message>
        <source>Leave {0} out</source>
        <translation>{0} weglassen</translation>
    </message>
    <message>
        <source>Free {0}</source>
        <translation>{0} freigeben</translation>
    </message>
    <message>
        <source>Hold {0} at 0</source>
        <translation>{0} bei 0 festhalten</translation>
    </message>
    <message>
        <source>Estimate the skew</source>
        <translation>Scherung schätzen</translation>
    </message>
    <message>
        <source>Weigh views by their noise</source>
        <translation>Nach Rauschen wichten</translation>
    </message>
    <message>
        <source>Look at {0}</source>
        <translation>{0} ansehen</translation>
    </message>
    <message>
        <source>Show where to hold the board</source>
        <translation>Zeigen, wohin das Brett soll</translation>
    </message>
</context>
<context>
    <name>Videos</name>
    <message>
        <source>Decoding {0}</source>
        <translation>{0} entschlüsseln</translation>
    </message>
    <message>
        <source>Finding corners</source>
        <translation>Ecken finden</translation>
    </message>
</context>
<context>
    <name>Welcome</name>
    <message>
        <source>Calibrate a camera</source>
        <translation>Eine Kamera kalibrieren</translation>
    </message>
    <message>
        <source>Drop photographs of a flat board here, or a saved project. The board&apos;s kind and size are found.</source>
        <translation>Fotos eines ebenen Bretts hier ablegen, oder ein gespeichertes Projekt. Art und Größe des Bretts werden gefunden.</translation>
    </message>
    <message>
        <source>Open a f&amp;older of images</source>
        <translation>&amp;Ordner mit Bildern öffnen</translation>
    </message>
    <message>
        <source>Corners are found and the camera is calibrated at once.</source>
        <translation>Ecken werden gefunden, die Kamera wird sofort kalibriert.</translation>
    </message>
    <message>
        <source>&amp;Photograph live</source>
        <translation>Live &amp;fotografieren</translation>
    </message>
    <message>
        <source>The camera&apos;s image shows where to hold the board.</source>
        <translation>Das Bild der Kamera zeigt, wohin das Brett soll.</translation>
    </message>
    <message>
        <source>&amp;Add images</source>
        <translation>Bilder &amp;hinzufügen</translation>
    </message>
    <message>
        <source>Choose single files.</source>
        <translation>Einzelne Dateien wählen.</translation>
    </message>
    <message>
        <source>Open the &amp;sample</source>
        <translation>&amp;Beispiel öffnen</translation>
    </message>
    <message>
        <source>Fourteen rendered photographs, to look around.</source>
        <translation>Vierzehn gerechnete Fotos zum Umsehen.</translation>
    </message>
    <message>
        <source>Take the to&amp;ur</source>
        <translation>R&amp;undgang</translation>
    </message>
    <message>
        <source>Prin&amp;t a board</source>
        <translation>Bre&amp;tt drucken</translation>
    </message>
    <message>
        <source>Two minutes on the sample; it can be left at any step.</source>
        <translation>Zwei Minuten am Beispiel; jederzeit zu verlassen.</translation>
    </message>
    <message>
        <source>A checkerboard, or one of the other kinds, in true size.</source>
        <translation>Ein Schachbrett oder eine andere Art, in wahrer Größe.</translation>
    </message>
    <message>
        <source>Recent projects and folders</source>
        <translation>Letzte Projekte und Ordner</translation>
    </message>
</context>
<context>
    <name>WorldReading</name>
    <message>
        <source>ray {0:.2f}° {1}, {2:.2f}° {3}</source>
        <translation>Strahl {0:.2f}° {1}, {2:.2f}° {3}</translation>
    </message>
    <message>
        <source>left</source>
        <translation>links</translation>
    </message>
    <message>
        <source>right</source>
        <translation>rechts</translation>
    </message>
    <message>
        <source>up</source>
        <translation>oben</translation>
    </message>
    <message>
        <source>down</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>   board X {0:.2f}, Y {1:.2f} mm</source>
        <translation>   Brett X {0:.2f}, Y {1:.2f} mm</translation>
    </message>
</context>
<context>
    <name>actions</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>files</name>
    <message>
        <source>Replace a file</source>
        <translation>Datei ersetzen</translation>
    </message>
    <message>
        <source>{0} exists. Replace it?</source>
        <translation>{0} gibt es. Ersetzen?</translation>
    </message>
</context>
<context>
    <name>glossary</name>
    <message>
        <source>Focal length along the image&apos;s rows, in widths of a pixel.</source>
        <translation>Brennweite entlang der Bildzeilen, in Breiten eines Pixels.</translation>
    </message>
    <message>
        <source>Focal length along the image&apos;s columns, in heights of a pixel.</source>
        <translation>Brennweite entlang der Bildspalten, in Höhen eines Pixels.</translation>
    </message>
    <message>
        <source>Column of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>Spalte des Bildhauptpunkts, wo die Achse der Linse auftrifft, px.</translation>
    </message>
    <message>
        <source>Row of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>Zeile des Bildhauptpunkts, wo die Achse der Linse auftrifft, px.</translation>
    </message>
    <message>
        <source>Lean of the pixel&apos;s columns, px; 0 for every sensor of today.</source>
        <translation>Schräge der Pixelspalten, px; 0 bei jedem Sensor von heute.</translation>
    </message>
    <message>
        <source>First coefficient of the radial distortion, of the lowest power.</source>
        <translation>Erster Koeffizient der radialen Verzeichnung, der kleinsten Potenz.</translation>
    </message>
    <message>
        <source>Second coefficient of the radial distortion.</source>
        <translation>Zweiter Koeffizient der radialen Verzeichnung.</translation>
    </message>
    <message>
        <source>Third coefficient of the radial distortion.</source>
        <translation>Dritter Koeffizient der radialen Verzeichnung.</translation>
    </message>
    <message>
        <source>Decentering distortion, of a lens whose elements are out of line.</source>
        <translation>Dezentrierung, von einer Linse, deren Glieder nicht fluchten.</translation>
    </message>
    <message>
        <source>Growth of the decentering distortion with the radius squared.</source>
        <translation>Zunahme der Dezentrierung mit dem Quadrat des Radius.</translation>
    </message>
    <message>
        <source>The value with its standard deviation: two times in three it is so far off or less.</source>
        <translation>Der Wert mit seiner Standardabweichung: in zwei von drei Fällen ist er so weit daneben oder weniger.</translation>
    </message>
    <message>
        <source>Standard deviation: two times in three a value is so far off or less.</source>
        <translation>Standardabweichung: in zwei von drei Fällen ist ein Wert so weit daneben oder weniger.</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>in σ</translation>
    </message>
    <message>
        <source>A difference in standard deviations: more than 3 is hardly chance.</source>
        <translation>Ein Unterschied in Standardabweichungen: mehr als 3 ist kaum Zufall.</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>Std. nach Tabelle 2</translation>
    </message>
    <message>
        <source>The standard deviation as the paper computes it, which leaves the size of the residuals out.</source>
        <translation>Die Standardabweichung, wie der Aufsatz sie rechnet, ohne die Größe der Residuen.</translation>
    </message>
    <message>
        <source>Root mean square: the typical length of the residuals, in which large ones count most.</source>
        <translation>Quadratisches Mittel: die typische Länge der Residuen, in der große am meisten zählen.</translation>
    </message>
    <message>
        <source>residual</source>
        <translation>Residuum</translation>
    </message>
    <message>
        <source>What a corner was measured at, less where camera and board put it.</source>
        <translation>Wo eine Ecke gemessen wurde, minus wohin Kamera und Brett sie setzen.</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s rows: measured less predicted column.</source>
        <translation>Residuum entlang der Bildzeilen: gemessene minus vorhergesagte Spalte.</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s columns: measured less predicted row.</source>
        <translation>Residuum entlang der Bildspalten: gemessene minus vorhergesagte Zeile.</translation>
    </message>
    <message>
        <source>Length of a residual in the image.</source>
        <translation>Länge eines Residuums im Bild.</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>Referenz-px</translation>
    </message>
    <message>
        <source>The paper&apos;s unit on the board: a square has 30 of them, whatever its size in the image.</source>
        <translation>Die Einheit des Aufsatzes auf dem Brett: ein Quadrat hat 30 davon, wie groß es im Bild auch ist.</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s rows, on the paper&apos;s reference plane.</source>
        <translation>Residuum entlang der Brettzeilen, auf der Referenzebene des Aufsatzes.</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s columns, on the paper&apos;s reference plane.</source>
        <translation>Residuum entlang der Brettspalten, auf der Referenzebene des Aufsatzes.</translation>
    </message>
    <message>
        <source>Length of a residual on the paper&apos;s reference plane, where a square has 30 px.</source>
        <translation>Länge eines Residuums auf der Referenzebene des Aufsatzes, wo ein Quadrat 30 px hat.</translation>
    </message>
    <message>
        <source>aspect ratio</source>
        <translation>Seitenverhältnis</translation>
    </message>
    <message>
        <source>Width of a pixel over its height, fy over fx; 1 for square pixels.</source>
        <translation>Breite eines Pixels durch seine Höhe, fy durch fx; 1 bei quadratischen Pixeln.</translation>
    </message>
    <message>
        <source>The paper&apos;s equation of cosines: where it is 0, r is the aspect ratio that one view gives by itself.</source>
        <translation>Die Kosinusgleichung des Aufsatzes: wo sie 0 ist, ist r das Seitenverhältnis, das eine Ansicht für sich gibt.</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>Kosten c</translation>
    </message>
    <message>
        <source>The mean squared residual that the calibration makes as small as it can.</source>
        <translation>Das mittlere quadrierte Residuum, das die Kalibrierung so klein macht, wie sie kann.</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>Iteration</translation>
    </message>
    <message>
        <source>One improvement of all parameters together.</source>
        <translation>Eine Verbesserung aller Parameter zusammen.</translation>
    </message>
    <message>
        <source>density</source>
        <translation>Dichte</translation>
    </message>
    <message>
        <source>Share of the residuals for each px of their length, so that all bars have area 1.</source>
        <translation>Anteil der Residuen je px ihrer Länge, so dass alle Balken die Fläche 1 haben.</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>Entfernung</translation>
    </message>
    <message>
        <source>Distance from the camera to the middle of the board.</source>
        <translation>Entfernung von der Kamera zur Mitte des Bretts.</translation>
    </message>
    <message>
        <source>tilt</source>
        <translation>Neigung</translation>
    </message>
    <message>
        <source>Angle between the board and the image plane; 0 if the camera looks straight at it.</source>
        <translation>Winkel zwischen Brett und Bildebene; 0, wenn die Kamera gerade darauf blickt.</translation>
    </message>
    <message>
        <source>displacement d</source>
        <translation>Verschiebung d</translation>
    </message>
    <message>
        <source>How far the lens moves the image of a point from where a pinhole would put it.</source>
        <translation>Wie weit die Linse das Bild eines Punktes von dort verschiebt, wohin ein Loch es setzte.</translation>
    </message>
    <message>
        <source>one σ, worst direction</source>
        <translation>ein σ, schlechteste Richtung</translation>
    </message>
    <message>
        <source>How uncertain the image of a point is along the direction in which that is worst.</source>
        <translation>Wie unsicher das Bild eines Punktes in der Richtung ist, in der es am schlechtesten bekannt ist.</translation>
    </message>
    <message>
        <source>correlated errors</source>
        <translation>korrelierte Fehler</translation>
    </message>
    <message>
        <source>Errors of neighbouring corners that point the same way, so that many corners tell less than their number.</source>
        <translation>Fehler benachbarter Ecken, die in dieselbe Richtung zeigen, so dass viele Ecken weniger sagen als ihre Zahl.</translation>
    </message>
    <message>
        <source>share errors</source>
        <translation>teilen Fehler</translation>
    </message>
    <message>
        <source>Of corners: neighbours are off alike, so that many tell less than their number.</source>
        <translation>Von Ecken: Nachbarn liegen gleich daneben, so dass viele weniger sagen als ihre Zahl.</translation>
    </message>
    <message>
        <source>unseen views</source>
        <translation>ungesehene Ansichten</translation>
    </message>
    <message>
        <source>Views that were left out of a calibration, to see how well it predicts them.</source>
        <translation>Ansichten, die bei einer Kalibrierung weggelassen wurden, um zu sehen, wie gut sie sie vorhersagt.</translation>
    </message>
    <message>
        <source>Bayesian information criterion: misfit plus a price for each parameter; the least is best.</source>
        <translation>Bayessches Informationskriterium: Abweichung plus ein Preis für jeden Parameter; das kleinste ist das beste.</translation>
    </message>
    <message>
        <source>Column of a pixel: 0 at the middle of the leftmost one.</source>
        <translation>Spalte eines Pixels: 0 in der Mitte des linkesten.</translation>
    </message>
    <message>
        <source>Row of a pixel: 0 at the middle of the topmost one, growing downwards.</source>
        <translation>Zeile eines Pixels: 0 in der Mitte des obersten, nach unten wachsend.</translation>
    </message>
</context>
<context>
    <name>lengths</name>
    <message>
        <source> if circles are {0:g} mm apart</source>
        <translation> wenn Kreise {0:g} mm auseinander sind</translation>
    </message>
    <message>
        <source> if tags are {0:g} mm</source>
        <translation> wenn Marken {0:g} mm groß sind</translation>
    </message>
    <message>
        <source> if squares are {0:g} mm</source>
        <translation> wenn Quadrate {0:g} mm groß sind</translation>
    </message>
    <message>
        <source>Lengths hold{0}.</source>
        <translation>Längen gelten{0}.</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
</context>
<context>
    <name>modes</name>
    <message>
        <source>Photographs</source>
        <translation>Fotos</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Verfahren</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Anpassung</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Linse</translation>
    </message>
    <message>
        <source>Board</source>
        <translation>Brett</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>3-D</translation>
    </message>
    <message>
        <source>Undistort</source>
        <translation>Entzerren</translation>
    </message>
    <message>
        <source>Compare</source>
        <translation>Vergleichen</translation>
    </message>
    <message>
        <source>The photographs, and what was found in them.</source>
        <translation>Die Fotos, und was in ihnen gefunden wurde.</translation>
    </message>
    <message>
        <source>How the camera was found, step by step as in the paper.</source>
        <translation>Wie die Kamera gefunden wurde, Schritt für Schritt wie im Aufsatz.</translation>
    </message>
    <message>
        <source>How well the photographs agree, and every value.</source>
        <translation>Wie gut die Fotos übereinstimmen, und jeder Wert.</translation>
    </message>
    <message>
        <source>What the lens does, and which model describes it.</source>
        <translation>Was die Linse tut, und welches Modell sie beschreibt.</translation>
    </message>
    <message>
        <source>How the real board differs from the drawing.</source>
        <translation>Wie das echte Brett von der Zeichnung abweicht.</translation>
    </message>
    <message>
        <source>Where the board was held, and where to hold it next.</source>
        <translation>Wo das Brett gehalten wurde, und wohin es als Nächstes soll.</translation>
    </message>
    <message>
        <source>Photographs without the distortion of the lens.</source>
        <translation>Fotos ohne die Verzeichnung der Linse.</translation>
    </message>
    <message>
        <source>Two results side by side.</source>
        <translation>Zwei Ergebnisse nebeneinander.</translation>
    </message>
</context>
<context>
    <name>plots</name>
    <message>
        <source>Copy as image</source>
        <translation>Als Bild kopieren</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>Diagramm speichern…</translation>
    </message>
    <message>
        <source>Save plot</source>
        <translation>Diagramm speichern</translation>
    </message>
    <message>
        <source>PNG image (*.png);;SVG drawing (*.svg)</source>
        <translation>PNG-Bild (*.png);;SVG-Zeichnung (*.svg)</translation>
    </message>
</context>
<context>
    <name>questions</name>
    <message>
        <source>&amp;Yes</source>
        <translation>&amp;Ja</translation>
    </message>
    <message>
        <source>&amp;No</source>
        <translation>&amp;Nein</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>&amp;Speichern</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>Speichern &amp;unter…</translation>
    </message>
    <message>
        <source>&amp;Discard</source>
        <translation>&amp;Verwerfen</translation>
    </message>
    <message>
        <source>&amp;Cancel</source>
        <translation>&amp;Abbrechen</translation>
    </message>
</context>
<context>
    <name>status_text</name>
    <message>
        <source>not searched</source>
        <translation>nicht abgesucht</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>kein Brett</translation>
    </message>
    <message>
        <source>unreadable</source>
        <translation>unlesbar</translation>
    </message>
    <message>
        <source>wrong size</source>
        <translation>falsche Größe</translation>
    </message>
    <message>
        <source>found</source>
        <translation>gefunden</translation>
    </message>
    <message>
        <source>{0} of {1}, ambiguous</source>
        <translation>{0} von {1}, mehrdeutig</translation>
    </message>
    <message>
        <source>{0} of {1} corners</source>
        <translation>{0} von {1} Ecken</translation>
    </message>
    <message>
        <source>{0} corners</source>
        <translation>{0} Ecken</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>weggelassen</translation>
    </message>
</context>
<context>
    <name>status_tip</name>
    <message>
        <source>Which part of the board is seen cannot be decided from it.</source>
        <translation>Welcher Teil des Bretts zu sehen ist, lässt sich daraus nicht entscheiden.</translation>
    </message>
    <message>
        <source>A turn of the board by {0} cannot be seen in its pattern.</source>
        <translation>Eine Drehung des Bretts um {0} ist in seinem Muster nicht zu sehen.</translation>
    </message>
    <message>
        <source>Another board is seen here, of {0} × {1} inner corners.</source>
        <translation>Hier ist ein anderes Brett zu sehen, mit {0} × {1} inneren Ecken.</translation>
    </message>
</context>
</TS>
