<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="es">
<context>
    <name>Banner</name>
    <message>
        <source>Dismiss this message</source>
        <translation>Cerrar este mensaje</translation>
    </message>
</context>
<context>
    <name>BeforeAndAfter</name>
    <message>
        <source>Error of a pixel before and after</source>
        <translation>Error de un píxel antes y después</translation>
    </message>
    <message>
        <source>Parameters before and after</source>
        <translation>Parámetros antes y después</translation>
    </message>
    <message>
        <source>Distance between a point&apos;s images before and after, after the rotation that
brings the two closest where corners (dots) were seen.</source>
        <translation>Distancia entre las imágenes de un punto antes y después, tras el giro
que más las acerca donde se vieron esquinas (puntos).</translation>
    </message>
    <message>
        <source>&amp;Keep</source>
        <translation>&amp;Conservar</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>&amp;Deshacer</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is {1} times smaller</source>
        <translation>{0}: el error donde hay esquinas es {1} veces menor</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is not smaller</source>
        <translation>{0}: el error donde hay esquinas no es menor</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parámetro</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>Antes</translation>
    </message>
    <message>
        <source>After</source>
        <translation>Después</translation>
    </message>
    <message>
        <source>Change</source>
        <translation>Cambio</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.</source>
        <translation>Dividido por la desviación estándar de una diferencia de estimaciones independientes.</translation>
    </message>
    <message>
        <source>The difference is being computed.</source>
        <translation>Se calcula la diferencia.</translation>
    </message>
    <message>
        <source>Error, {0} [px]</source>
        <translation>Error, {0} [px]</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>centro</translation>
    </message>
    <message>
        <source>among corners</source>
        <translation>entre esquinas</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>borde</translation>
    </message>
    <message>
        <source>worst</source>
        <translation>peor</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Veredicto</translation>
    </message>
</context>
<context>
    <name>BoardList</name>
    <message>
        <source>Boards</source>
        <translation>Tableros</translation>
    </message>
    <message>
        <source>Add a &amp;board</source>
        <translation>Añadir ta&amp;blero</translation>
    </message>
    <message>
        <source>Re&amp;move</source>
        <translation>&amp;Quitar</translation>
    </message>
    <message>
        <source>A further board that stands fast to the first and is told from it by its markers or tags</source>
        <translation>Otro tablero, fijo respecto al primero, que se distingue de él por sus marcadores o etiquetas</translation>
    </message>
    <message>
        <source>As the photo&amp;graphs show it</source>
        <translation>Como lo muestran las &amp;fotos</translation>
    </message>
    <message>
        <source>Take the board that the photographs show; turn it off to state it.</source>
        <translation>Tomar el tablero que muestran las fotos; desactive para indicarlo.</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation type="unfinished">sin indicar</translation>
    </message>
    <message>
        <source> mm</source>
        <translation type="unfinished"> mm</translation>
    </message>
    <message>
        <source>taken as {0} mm</source>
        <translation>se toma {0} mm</translation>
    </message>
    <message>
        <source>Not measured if 0: all lengths then hold for squares so long</source>
        <translation>Si es 0, no medido: todas las longitudes valen entonces para cuadros así</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation type="unfinished">Lado de un cuadro</translation>
    </message>
    <message>
        <source>Stands where I &amp;know</source>
        <translation>Posición &amp;conocida</translation>
    </message>
    <message>
        <source>State where the board stands beside the first one; turn it off to have that estimated with the rig.</source>
        <translation>Indique dónde está el tablero respecto al primero; desactivado, se estima con el conjunto.</translation>
    </message>
    <message>
        <source>{0}, mm</source>
        <translation>{0}, mm</translation>
    </message>
    <message>
        <source>rotation vector, {0}, degrees</source>
        <translation>vector de rotación, {0}, grados</translation>
    </message>
    <message>
        <source>Beside board 1, in mm and degrees:</source>
        <translation>Junto al tablero 1, en mm y grados:</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>Tablero {0}</translation>
    </message>
</context>
<context>
    <name>BoardPanel</name>
    <message>
        <source>&amp;Counted in the images</source>
        <translation>Con&amp;tadas en las imágenes</translation>
    </message>
    <message>
        <source>Take the size that most images show; turn it off to state it.</source>
        <translation>Tomar el tamaño que muestra la mayoría de las imágenes; desactívelo para indicarlo.</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>filas de esquinas interiores</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>columnas de esquinas interiores</translation>
    </message>
    <message>
        <source>Corners where four squares meet: one fewer than squares each way.</source>
        <translation>Esquinas donde se juntan cuatro cuadros: una menos que cuadros en cada sentido.</translation>
    </message>
    <message>
        <source>Side of one square. Only the distances depend on it: measure several squares together and divide.</source>
        <translation>Lado de un cuadro. Solo las distancias dependen de él: mida varios cuadros juntos y divida.</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Lado de un cuadro</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exacto</translation>
    </message>
    <message>
        <source>One standard deviation of the side, which all squares share: every length is uncertain by the same share. A certificate&apos;s U (k = 2) is twice as much.</source>
        <translation>Una desviación estándar del lado, común a todos los cuadros: cada longitud es incierta en la misma proporción. La U de un certificado (k = 2) es el doble.</translation>
    </message>
    <message>
        <source>Standard deviation of the side of a square</source>
        <translation>Desviación estándar del lado de un cuadro</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Unidad</translation>
    </message>
    <message>
        <source>by their edges</source>
        <translation>por sus bordes</translation>
    </message>
    <message>
        <source>Fit the edges that cross at each corner, as exactly as the noise allows, and tell how exact that is.</source>
        <translation>Ajustar los bordes que se cruzan en cada esquina, con la exactitud que permite el ruido, y decir cuánta es.</translation>
    </message>
    <message>
        <source>by the saddle point</source>
        <translation>por el punto de silla</translation>
    </message>
    <message>
        <source>As the paper does: the saddle point of the grey levels at each corner.</source>
        <translation>Como en el artículo: el punto de silla de los niveles de gris en cada esquina.</translation>
    </message>
    <message>
        <source>How corners are located; another way searches anew.</source>
        <translation>Cómo se localizan las esquinas; otra manera busca de nuevo.</translation>
    </message>
    <message>
        <source>all rows</source>
        <translation>todas las filas</translation>
    </message>
    <message>
        <source>odd rows</source>
        <translation>filas impares</translation>
    </message>
    <message>
        <source>even rows</source>
        <translation>filas pares</translation>
    </message>
    <message>
        <source>Search one field of interlaced frames, in which edges that moved between the two are not combed. The rows between are interpolated.</source>
        <translation>Buscar en un campo de imágenes entrelazadas, donde los bordes que se movieron no aparecen dentados. Las filas intermedias se interpolan.</translation>
    </message>
    <message>
        <source>Mar&amp;k all by hand</source>
        <translation>Marcar todo a &amp;mano</translation>
    </message>
    <message>
        <source>Images are not searched: point at each board&apos;s four outermost corners (M), and Enter goes on to the next image.</source>
        <translation>No se busca en las imágenes: señale las cuatro esquinas extremas de cada tablero (M); Intro pasa a la siguiente imagen.</translation>
    </message>
    <message>
        <source>read from the images</source>
        <translation>leído de las imágenes</translation>
    </message>
    <message>
        <source>Loca&amp;ted</source>
        <translation>&amp;Localizadas</translation>
    </message>
    <message>
        <source>Interlaced</source>
        <translation>Entrelazado</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>Lo que está impreso en el tablero.</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Número de esquinas</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>Patrón</translation>
    </message>
    <message>
        <source>Way to locate corners</source>
        <translation>Manera de localizar esquinas</translation>
    </message>
    <message>
        <source>Rows of interlaced frames</source>
        <translation>Filas de imágenes entrelazadas</translation>
    </message>
    <message>
        <source>Mark by hand</source>
        <translation>Marcar a mano</translation>
    </message>
    <message>
        <source>Search the images</source>
        <translation>Buscar en las imágenes</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>Tamaño de los cuadros</translation>
    </message>
    <message>
        <source>Uncertainty of squares</source>
        <translation>Incertidumbre de los cuadros</translation>
    </message>
    <message>
        <source>Unit of squares</source>
        <translation>Unidad de los cuadros</translation>
    </message>
</context>
<context>
    <name>BoardScreen</name>
    <message>
        <source>Board on the screen</source>
        <translation>Tablero en la pantalla</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>Length of the line</source>
        <translation>Longitud de la línea</translation>
    </message>
    <message>
        <source>&amp;Close (Esc)</source>
        <translation>&amp;Cerrar (Esc)</translation>
    </message>
    <message>
        <source>Measure the line above with a ruler:</source>
        <translation>Mida la línea de arriba con una regla:</translation>
    </message>
    <message>
        <source>A square is {0} pixels: {1} mm. State this length.</source>
        <translation>Un cuadro mide {0} píxeles: {1} mm. Indique esta longitud.</translation>
    </message>
    <message>
        <source>Circles are {0} pixels apart: {1} mm. State this length.</source>
        <translation>Los círculos distan {0} píxeles: {1} mm. Indique esta longitud.</translation>
    </message>
</context>
<context>
    <name>BoardShapeChoice</name>
    <message>
        <source>Shape of the board</source>
        <translation>Forma del tablero</translation>
    </message>
    <message>
        <source>as drawn</source>
        <translation>como dibujado</translation>
    </message>
    <message>
        <source>Flat and printed true (nominal). Its errors become the camera&apos;s.</source>
        <translation>Plano e impreso a medida (nominal). Sus errores pasan a la cámara.</translation>
    </message>
    <message>
        <source>stretched or askew</source>
        <translation>estirado u oblicuo</translation>
    </message>
    <message>
        <source>Sides of unequal scale, not quite at right angles (affine).</source>
        <translation>Lados de escala desigual, no del todo en ángulo recto (affine).</translation>
    </message>
    <message>
        <source>bowed</source>
        <translation>arqueado</translation>
    </message>
    <message>
        <source>Bent along rows and columns (bow).</source>
        <translation>Doblado a lo largo de filas y columnas (bow).</translation>
    </message>
    <message>
        <source>free: every corner</source>
        <translation>libre: cada esquina</translation>
    </message>
    <message>
        <source>Every corner is estimated in three dimensions (free). Needs 6 views, and every corner in 4 of them, or a prior.</source>
        <translation>Cada esquina se estima en tres dimensiones (free). Requiere 6 vistas, y cada esquina en 4 de ellas, o conocimiento previo.</translation>
    </message>
    <message>
        <source>what predicts best</source>
        <translation>lo que mejor predice</translation>
    </message>
    <message>
        <source>Of these, the one that predicts views best that it has not seen. Slow.</source>
        <translation>De estas, la que mejor predice vistas que no ha visto. Lento.</translation>
    </message>
    <message>
        <source>as in a file…</source>
        <translation>como en un archivo…</translation>
    </message>
    <message>
        <source>Hold a shape that was saved before.</source>
        <translation>Fijar una forma guardada antes.</translation>
    </message>
    <message>
        <source>known to</source>
        <translation>conocido a</translation>
    </message>
    <message>
        <source> mm in plane</source>
        <translation> mm en el plano</translation>
    </message>
    <message>
        <source>Standard deviation of the print in the plane, mm</source>
        <translation>Desviación estándar de la impresión en el plano, mm</translation>
    </message>
    <message>
        <source> mm off plane</source>
        <translation> mm fuera</translation>
    </message>
    <message>
        <source>Standard deviation out of the plane: flatness, mm</source>
        <translation>Desviación estándar fuera del plano: planitud, mm</translation>
    </message>
    <message>
        <source>State how far corners may be from where they should be: in the plane, and out of it. Every ± counts it, and few views can then carry a free board.</source>
        <translation>Indicar cuánto pueden apartarse las esquinas de su lugar: en el plano y fuera de él. Cada ± lo cuenta, y pocas vistas bastan entonces para un tablero libre.</translation>
    </message>
    <message>
        <source>Boar&amp;d is</source>
        <translation>El &amp;tablero es</translation>
    </message>
    <message>
        <source>as in a file: {0:.2g} mm off</source>
        <translation>de archivo: {0:.2g} mm de desvío</translation>
    </message>
    <message>
        <source>The board&apos;s shape</source>
        <translation>La forma del tablero</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>Formas (*.json)</translation>
    </message>
</context>
<context>
    <name>BoardShapePanel</name>
    <message>
        <source>Board shape</source>
        <translation>Forma del tablero</translation>
    </message>
    <message>
        <source>How the real board deviates from its drawing.</source>
        <translation>Cómo se aparta el tablero real de su dibujo.</translation>
    </message>
    <message>
        <source>&amp;Save shape…</source>
        <translation>&amp;Guardar forma…</translation>
    </message>
    <message>
        <source>Write the board&apos;s shape to a file, for later calibrations with the same board: Set-up, Board is: as in a file.</source>
        <translation>Escribir la forma del tablero en un archivo, para calibraciones posteriores con el mismo tablero: Ajustes, El tablero es: como en un archivo.</translation>
    </message>
    <message>
        <source>X on the board</source>
        <translation>X en el tablero</translation>
    </message>
    <message>
        <source>Y on the board</source>
        <translation>Y en el tablero</translation>
    </message>
    <message>
        <source>Arrows: from where corners should be to where they are, magnified.
Colours: out of the plane; red is away from the camera.</source>
        <translation>Flechas: de donde deberían estar las esquinas a donde están, ampliadas.
Colores: fuera del plano; rojo se aleja de la cámara.</translation>
    </message>
    <message>
        <source>The board was taken as drawn. To estimate its shape, choose “free” or another model at “Board is” in the Set-up and calibrate again.</source>
        <translation>El tablero se tomó como dibujado. Para estimar su forma, elija «libre» u otro modelo en «El tablero es» de los Ajustes y calibre de nuevo.</translation>
    </message>
    <message>
        <source>out of the plane [{0}]</source>
        <translation>fuera del plano [{0}]</translation>
    </message>
    <message>
        <source>{0:g} mm in the plane</source>
        <translation>{0:g} mm en el plano</translation>
    </message>
    <message>
        <source> Each is known to ± {0:.2g} mm (1σ, median).</source>
        <translation> Cada una se conoce a ± {0:.2g} mm (1σ, mediana).</translation>
    </message>
    <message>
        <source>Point at a corner to read it.</source>
        <translation>Señale una esquina para leerla.</translation>
    </message>
    <message>
        <source>({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm</source>
        <translation>({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm</translation>
    </message>
    <message>
        <source>Save the board&apos;s shape</source>
        <translation>Guardar la forma del tablero</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>Formas (*.json)</translation>
    </message>
</context>
<context>
    <name>BugDialog</name>
    <message>
        <source>Something went wrong</source>
        <translation>Algo ha fallado</translation>
    </message>
    <message>
        <source>This is a fault of the program, not of your images. Your work has been kept. Please report the text below; you can go on, or save and start again.</source>
        <translation>Es un fallo del programa, no de sus imágenes. Su trabajo se ha guardado. Comunique por favor el texto de abajo; puede seguir, o guardar y empezar de nuevo.</translation>
    </message>
    <message>
        <source>What to report</source>
        <translation>Qué comunicar</translation>
    </message>
    <message>
        <source>&amp;Copy</source>
        <translation>&amp;Copiar</translation>
    </message>
</context>
<context>
    <name>Calibrator</name>
    <message>
        <source>Calibrating</source>
        <translation>Calibrando</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>Comparando modelos de lente</translation>
    </message>
    <message>
        <source>Making the camera better</source>
        <translation>Mejorando la cámara</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>Calibración</translation>
    </message>
    <message>
        <source>Known camera</source>
        <translation>Cámara conocida</translation>
    </message>
    <message>
        <source>No board is marked yet, and the search is off.</source>
        <translation>Aún no hay ningún tablero marcado, y la búsqueda está desactivada.</translation>
    </message>
    <message>
        <source>Mark the four outermost corners in at least three photographs (Mark board), or turn “Mark all by hand” off.</source>
        <translation>Marque las cuatro esquinas extremas en al menos tres fotos (Marcar tablero), o desactive «Marcar todo a mano».</translation>
    </message>
    <message>
        <source>None of the photographs can be read.</source>
        <translation>No se puede leer ninguna de las fotos.</translation>
    </message>
    <message>
        <source>Click on one to see why, or add others.</source>
        <translation>Pulse una para ver por qué, o añada otras.</translation>
    </message>
    <message>
        <source>There is no image to calibrate from.</source>
        <translation>No hay imagen con la que calibrar.</translation>
    </message>
    <message>
        <source>Add photographs of a board.</source>
        <translation>Añada fotos de un tablero.</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>Mejorar la cámara</translation>
    </message>
    <message>
        <source>Calibrate</source>
        <translation>Calibrar</translation>
    </message>
    <message>
        <source>Stopped: “{0}” is the best so far, not the optimum.</source>
        <translation>Detenido: «{0}» es lo mejor hasta ahora, no el óptimo.</translation>
    </message>
</context>
<context>
    <name>CameraValues</name>
    <message>
        <source>Result</source>
        <translation>Resultado</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>Cada calibración guarda su resultado con un nombre</translation>
    </message>
    <message>
        <source>manage</source>
        <translation>gestionar</translation>
    </message>
    <message>
        <source>Rename, delete or compare results</source>
        <translation>Renombrar, borrar o comparar resultados</translation>
    </message>
    <message>
        <source>&amp;Compare with</source>
        <translation>&amp;Comparar con</translation>
    </message>
    <message>
        <source>&amp;Rename…</source>
        <translation>&amp;Renombrar…</translation>
    </message>
    <message>
        <source>&amp;Delete</source>
        <translation>&amp;Borrar</translation>
    </message>
    <message>
        <source>All values, correlations, the paper&apos;s units ›</source>
        <translation>Todos los valores, correlaciones, unidades ›</translation>
    </message>
    <message>
        <source>Show everything that is known of this result</source>
        <translation>Mostrar todo lo que se sabe de este resultado</translation>
    </message>
    <message>
        <source>Still good? Check with new photographs ›</source>
        <translation>¿Aún buena? Comprobar con fotos nuevas ›</translation>
    </message>
    <message>
        <source>Or drop them here: they check the camera, and join no project</source>
        <translation>O suéltelas aquí: comprueban la cámara y no entran en ningún proyecto</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
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
        <translation>Límite</translation>
    </message>
    <message>
        <source>Change from which the camera counts as changed, px rms</source>
        <translation>Cambio a partir del cual la cámara cuenta como cambiada, px (RMS)</translation>
    </message>
    <message>
        <source>C&amp;heck with others…</source>
        <translation>Comprobar con &amp;otras…</translation>
    </message>
    <message>
        <source>&amp;Close</source>
        <translation>&amp;Cerrar</translation>
    </message>
    <message>
        <source>&amp;Limit</source>
        <translation>&amp;Límite</translation>
    </message>
    <message>
        <source>Images ({0})</source>
        <translation>Imágenes ({0})</translation>
    </message>
    <message>
        <source>New photographs of the board</source>
        <translation>Fotos nuevas del tablero</translation>
    </message>
    <message>
        <source>Checking the camera</source>
        <translation>Comprobando la cámara</translation>
    </message>
    <message>
        <source>These photographs cannot be used</source>
        <translation>Estas fotos no sirven para comprobar</translation>
    </message>
    <message>
        <source>Is the camera still good?</source>
        <translation>¿Sigue siendo buena la cámara?</translation>
    </message>
    <message>
        <source>The photographs are searched for the board. They join no project.</source>
        <translation>Se busca el tablero en las fotos. No entran en ningún proyecto.</translation>
    </message>
    <message>
        <source>STILL GOOD</source>
        <translation>SIGUE SIENDO BUENA</translation>
    </message>
    <message>
        <source>CALIBRATE AGAIN</source>
        <translation>CALIBRE DE NUEVO</translation>
    </message>
    <message>
        <source>TAKE OTHER PHOTOGRAPHS</source>
        <translation>HAGA OTRAS FOTOS</translation>
    </message>
    <message>
        <source>{0} of {1} photographs, the stored camera as it is: RMS {2:.3f} px, σ {3:.3f} px of {4:,} corners.</source>
        <translation>{0} de {1} fotos, con la cámara guardada: RMS {2:.3f} px, σ {3:.3f} px de {4:,} esquinas.</translation>
    </message>
</context>
<context>
    <name>Commands</name>
    <message>
        <source>&amp;Images</source>
        <translation>&amp;Imágenes</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Archivo</translation>
    </message>
    <message>
        <source>&amp;New project</source>
        <translation>Proyecto &amp;nuevo</translation>
    </message>
    <message>
        <source>Begin with nothing</source>
        <translation>Empezar sin nada</translation>
    </message>
    <message>
        <source>&amp;Open project…</source>
        <translation>&amp;Abrir proyecto…</translation>
    </message>
    <message>
        <source>Open a saved project</source>
        <translation>Abrir un proyecto guardado</translation>
    </message>
    <message>
        <source>Open &amp;recent</source>
        <translation>Abrir &amp;reciente</translation>
    </message>
    <message>
        <source>Open f&amp;leet…</source>
        <translation>Abrir &amp;flota…</translation>
    </message>
    <message>
        <source>Show the cameras of a ledger that calibgui batch wrote</source>
        <translation>Mostrar las cámaras de un registro que escribió calibgui batch</translation>
    </message>
    <message>
        <source>Open the sa&amp;mple</source>
        <translation>Abrir la &amp;muestra</translation>
    </message>
    <message>
        <source>Rendered photographs, to look around</source>
        <translation>Fotos sintéticas, para mirar alrededor</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>&amp;Guardar</translation>
    </message>
    <message>
        <source>Write the project to its file</source>
        <translation>Escribir el proyecto en su archivo</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>Guardar &amp;como…</translation>
    </message>
    <message>
        <source>Write the project to another file</source>
        <translation>Escribir el proyecto en otro archivo</translation>
    </message>
    <message>
        <source>Add &amp;images…</source>
        <translation>Añadir &amp;imágenes…</translation>
    </message>
    <message>
        <source>Choose image files</source>
        <translation>Elegir archivos de imagen</translation>
    </message>
    <message>
        <source>Add a &amp;folder…</source>
        <translation>Añadir &amp;carpeta…</translation>
    </message>
    <message>
        <source>Take all images of a folder</source>
        <translation>Tomar todas las imágenes de una carpeta</translation>
    </message>
    <message>
        <source>P&amp;hotograph live…</source>
        <translation>&amp;Fotografiar en vivo…</translation>
    </message>
    <message>
        <source>Take photographs with a camera that says where to hold the board</source>
        <translation>Hacer fotos con una cámara que dice dónde poner el tablero</translation>
    </message>
    <message>
        <source>Several &amp;cameras…</source>
        <translation>Varias &amp;cámaras…</translation>
    </message>
    <message>
        <source>Calibrate cameras that stand fast to each other: a rig</source>
        <translation>Calibrar cámaras fijas entre sí: un conjunto</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>&amp;Salir</translation>
    </message>
    <message>
        <source>Close the window</source>
        <translation>Cerrar la ventana</translation>
    </message>
    <message>
        <source>Projects and folders that were opened stand here</source>
        <translation>Los proyectos y carpetas abiertos aparecen aquí</translation>
    </message>
    <message>
        <source>No project or folder has been opened yet.</source>
        <translation>Aún no se ha abierto ningún proyecto ni carpeta.</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Ninguno aún</translation>
    </message>
    <message>
        <source>Open this project or folder</source>
        <translation>Abrir este proyecto o carpeta</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Edición</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>&amp;Deshacer</translation>
    </message>
    <message>
        <source>Take the last change back</source>
        <translation>Anular el último cambio</translation>
    </message>
    <message>
        <source>Nothing has been changed since the project was opened.</source>
        <translation>Nada ha cambiado desde que se abrió el proyecto.</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>&amp;Rehacer</translation>
    </message>
    <message>
        <source>Do what was undone</source>
        <translation>Hacer lo que se deshizo</translation>
    </message>
    <message>
        <source>Nothing has been undone.</source>
        <translation>No se ha deshecho nada.</translation>
    </message>
    <message>
        <source>&amp;Paste paths</source>
        <translation>&amp;Pegar rutas</translation>
    </message>
    <message>
        <source>Add the files on the clipboard</source>
        <translation>Añadir los archivos del portapapeles</translation>
    </message>
    <message>
        <source>Copy &amp;table</source>
        <translation>Copiar &amp;tabla</translation>
    </message>
    <message>
        <source>Put the table in sight on the clipboard, for a spreadsheet</source>
        <translation>Poner la tabla visible en el portapapeles, para una hoja de cálculo</translation>
    </message>
    <message>
        <source>No table is in sight: choose a panel with one first.</source>
        <translation>No hay tabla a la vista: elija primero un panel que tenga una.</translation>
    </message>
    <message>
        <source>Copy p&amp;lot as picture</source>
        <translation>Copiar &amp;gráfico como imagen</translation>
    </message>
    <message>
        <source>Put a picture of the plot in sight on the clipboard</source>
        <translation>Poner una imagen del gráfico visible en el portapapeles</translation>
    </message>
    <message>
        <source>No plot is in sight: choose a panel with one first.</source>
        <translation>No hay gráfico a la vista: elija primero un panel que tenga uno.</translation>
    </message>
    <message>
        <source>Cali&amp;bration</source>
        <translation>&amp;Calibración</translation>
    </message>
    <message>
        <source>&amp;Calibrate</source>
        <translation>&amp;Calibrar</translation>
    </message>
    <message>
        <source>Do everything that is still to do</source>
        <translation>Hacer todo lo que falta</translation>
    </message>
    <message>
        <source>There are no images yet: add some first.</source>
        <translation>Aún no hay imágenes: añada primero algunas.</translation>
    </message>
    <message>
        <source>S&amp;top</source>
        <translation>&amp;Detener</translation>
    </message>
    <message>
        <source>End what the progress bar tells of; what is finished stays</source>
        <translation>Terminar lo que indica la barra; lo acabado queda</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>&amp;Exportar…</translation>
    </message>
    <message>
        <source>Write the camera for OpenCV, ROS, MATLAB or another program</source>
        <translation>Escribir la cámara para OpenCV, ROS, MATLAB u otro programa</translation>
    </message>
    <message>
        <source>Nothing is calibrated yet: press Calibrate first.</source>
        <translation>Aún no hay nada calibrado: pulse primero Calibrar.</translation>
    </message>
    <message>
        <source>&amp;Report…</source>
        <translation>&amp;Informe…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page, or a certificate</source>
        <translation>Escribir lo que se sabe como PDF o página web, o un certificado</translation>
    </message>
    <message>
        <source>Chec&amp;k with new photographs…</source>
        <translation>C&amp;omprobar con fotos nuevas…</translation>
    </message>
    <message>
        <source>Whether the camera is still good; the project stays as it is</source>
        <translation>Si la cámara sigue siendo buena; el proyecto queda como está</translation>
    </message>
    <message>
        <source>&amp;Series of calibrations…</source>
        <translation>&amp;Serie de calibraciones…</translation>
    </message>
    <message>
        <source>How a camera varies with zoom, focus, temperature or date</source>
        <translation>Cómo varía una cámara con zoom, enfoque, temperatura o fecha</translation>
    </message>
    <message>
        <source>&amp;Hand and eye…</source>
        <translation>&amp;Mano y ojo…</translation>
    </message>
    <message>
        <source>Where the camera is in a robot&apos;s hand, or beside the robot</source>
        <translation>Dónde está la cámara en la mano de un robot, o junto al robot</translation>
    </message>
    <message>
        <source>&amp;Print a board…</source>
        <translation>Im&amp;primir un tablero…</translation>
    </message>
    <message>
        <source>Make a board of any size</source>
        <translation>Hacer un tablero de cualquier tamaño</translation>
    </message>
    <message>
        <source>As the &amp;system</source>
        <translation>Como el &amp;sistema</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Claro</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Oscuro</translation>
    </message>
    <message>
        <source>Choose light or dark colours</source>
        <translation>Elegir colores claros u oscuros</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ver</translation>
    </message>
    <message>
        <source>S&amp;how panel</source>
        <translation>&amp;Mostrar panel</translation>
    </message>
    <message>
        <source>The &amp;desk alone, or back</source>
        <translation>Solo la &amp;mesa, o volver</translation>
    </message>
    <message>
        <source>Hide the strip of images and the inspector, or show them again</source>
        <translation>Ocultar la tira de imágenes y el inspector, o mostrarlos de nuevo</translation>
    </message>
    <message>
        <source>&amp;Colours</source>
        <translation>&amp;Colores</translation>
    </message>
    <message>
        <source>What the window can show stands here</source>
        <translation>Lo que la ventana puede mostrar aparece aquí</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>A&amp;yuda</translation>
    </message>
    <message>
        <source>&amp;Manual</source>
        <translation>&amp;Manual</translation>
    </message>
    <message>
        <source>How to photograph, what a message means, who reads which file</source>
        <translation>Cómo fotografiar, qué significa un mensaje, quién lee cada archivo</translation>
    </message>
    <message>
        <source>Take the &amp;tour</source>
        <translation>&amp;Recorrido</translation>
    </message>
    <message>
        <source>Two minutes from one part of the window to the next</source>
        <translation>Dos minutos de una parte de la ventana a la siguiente</translation>
    </message>
    <message>
        <source>&amp;Find an action…</source>
        <translation>&amp;Buscar una acción…</translation>
    </message>
    <message>
        <source>Search everything that the menus can do</source>
        <translation>Buscar en todo lo que pueden hacer los menús</translation>
    </message>
</context>
<context>
    <name>ComparePanel</name>
    <message>
        <source>Compare</source>
        <translation>Comparar</translation>
    </message>
    <message>
        <source>Two results side by side: parameters, difference over the image, one image by both.</source>
        <translation>Dos resultados lado a lado: parámetros, diferencia en la imagen, una imagen con ambos.</translation>
    </message>
    <message>
        <source>Left result</source>
        <translation>Resultado izquierdo</translation>
    </message>
    <message>
        <source>Right result</source>
        <translation>Resultado derecho</translation>
    </message>
    <message>
        <source>Parameters of both results</source>
        <translation>Parámetros de ambos resultados</translation>
    </message>
    <message>
        <source>One image undistorted by both results</source>
        <translation>Una imagen corregida con ambos resultados</translation>
    </message>
    <message>
        <source>Parameters</source>
        <translation>Parámetros</translation>
    </message>
    <message>
        <source>Difference [px]</source>
        <translation>Diferencia [px]</translation>
    </message>
    <message>
        <source>Split image</source>
        <translation>Imagen dividida</translation>
    </message>
    <message>
        <source>and</source>
        <translation>y</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>Cada calibración guarda su resultado con un nombre</translation>
    </message>
    <message>
        <source>There is one result. Calibrate again with other settings or other images, and compare the two here.</source>
        <translation>Hay un resultado. Calibre de nuevo con otros ajustes u otras imágenes, y compare aquí los dos.</translation>
    </message>
    <message>
        <source>Comparing…</source>
        <translation>Comparando…</translation>
    </message>
    <message>
        <source>Comparing {0} and {1}</source>
        <translation>Comparando {0} y {1}</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parámetro</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Diferencia</translation>
    </message>
    <message>
        <source>{1} less {0}</source>
        <translation>{1} menos {0}</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>en σ</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.
Results from the same images share their errors: even 1 is much then.</source>
        <translation>Dividido por la desviación estándar de una diferencia de estimaciones independientes.
Los resultados de las mismas imágenes comparten errores: entonces incluso 1 es mucho.</translation>
    </message>
    <message>
        <source>differs by more than 3 σ</source>
        <translation>difiere en más de 3 σ</translation>
    </message>
    <message>
        <source>Where corners were seen the two image the same point up to {0} px apart, {1} px RMS.</source>
        <translation>Donde se vieron esquinas, los dos forman el mismo punto hasta a {0} px de distancia, {1} px RMS.</translation>
    </message>
    <message>
        <source>Of the parameters {0} differs most, by {1:.1f} σ.</source>
        <translation>De los parámetros, {0} es el que más difiere, en {1:.1f} σ.</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>Corrigiendo {0}</translation>
    </message>
</context>
<context>
    <name>ConvergencePanel</name>
    <message>
        <source>Convergence</source>
        <translation>Convergencia</translation>
    </message>
    <message>
        <source>The cost after each step, also while it runs.</source>
        <translation>El coste tras cada paso, también en marcha.</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>iteración</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>coste c</translation>
    </message>
    <message>
        <source>The sum of squared residuals that Stage II minimises, after each step.</source>
        <translation>La suma de residuos al cuadrado que la Etapa II minimiza, tras cada paso.</translation>
    </message>
    <message>
        <source>Calibrating…</source>
        <translation>Calibrando…</translation>
    </message>
    <message>
        <source>Calibrating: iteration {0}, RMS residual {1:.4f} {2}</source>
        <translation>Calibrando: iteración {0}, residuo RMS {1:.4f} {2}</translation>
    </message>
    <message>
        <source>The camera is known from a file: nothing was solved.</source>
        <translation>La cámara se conoce por un archivo: no se resolvió nada.</translation>
    </message>
    <message>
        <source>Weighted RMS residual {0:.4f} {1}; {2}.</source>
        <translation>Residuo RMS ponderado {0:.4f} {1}; {2}.</translation>
    </message>
    <message>
        <source>RMS residual {0:.4f} {1}; {2}.</source>
        <translation>Residuo RMS {0:.4f} {1}; {2}.</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>px de referencia</translation>
    </message>
    <message>
        <source>Converged after {0} iterations.</source>
        <translation>Convergió tras {0} iteraciones.</translation>
    </message>
    <message>
        <source>Converged after {0} iterations, with assumptions on what the views leave open.</source>
        <translation>Convergió tras {0} iteraciones, con supuestos sobre lo que las vistas dejan abierto.</translation>
    </message>
    <message>
        <source>Stopped after {0} iterations: the best so far is kept, but it is not the optimum.</source>
        <translation>Detenido tras {0} iteraciones: queda lo mejor hasta ahora, que no es el óptimo.</translation>
    </message>
    <message>
        <source>Not converged: all {0} iterations were used. Allow more, or hold parameters that the views do not determine.</source>
        <translation>No convergió: se usaron las {0} iteraciones. Permita más, o fije parámetros que las vistas no determinan.</translation>
    </message>
</context>
<context>
    <name>CornerBar</name>
    <message>
        <source>&amp;Done</source>
        <translation>&amp;Hecho</translation>
    </message>
    <message>
        <source>Drag a corner to move it, Delete removes it, a click on a red ring finds it again. Ctrl: do not snap.</source>
        <translation>Arrastre una esquina para moverla; Supr la quita, un clic en un anillo rojo la busca de nuevo. Ctrl: sin ajuste.</translation>
    </message>
    <message>
        <source>&amp;Turn 90°</source>
        <translation>&amp;Girar 90°</translation>
    </message>
    <message>
        <source>Count from the board&apos;s next corner</source>
        <translation>Contar desde la siguiente esquina del tablero</translation>
    </message>
    <message>
        <source>F&amp;lip</source>
        <translation>&amp;Voltear</translation>
    </message>
    <message>
        <source>Count columns from the other end: for mirrored images</source>
        <translation>Contar columnas desde el otro extremo: para imágenes reflejadas</translation>
    </message>
</context>
<context>
    <name>CostChoice</name>
    <message>
        <source>error in the image</source>
        <translation>error en la imagen</translation>
    </message>
    <message>
        <source>Distance between measured and predicted corners, px. The noise is in the image: this gives the smallest standard deviations.</source>
        <translation>Distancia entre esquinas medidas y predichas, px. El ruido está en la imagen: esto da las menores desviaciones estándar.</translation>
    </message>
    <message>
        <source>error on the reference plane</source>
        <translation>error en el plano de referencia</translation>
    </message>
    <message>
        <source>Distance between the corners registered on the board and where they should be. Far and tilted views weigh more.</source>
        <translation>Distancia entre las esquinas llevadas al tablero y donde deberían estar. Las vistas lejanas e inclinadas pesan más.</translation>
    </message>
    <message>
        <source>as printed in the paper</source>
        <translation>como impreso en el artículo</translation>
    </message>
    <message>
        <source>The formulation of the paper to the letter, to reproduce its tables.</source>
        <translation>La formulación del artículo al pie de la letra, para reproducir sus tablas.</translation>
    </message>
    <message>
        <source>Minimise</source>
        <translation>Minimizar</translation>
    </message>
</context>
<context>
    <name>CoveragePanel</name>
    <message>
        <source>Coverage</source>
        <translation>Cobertura</translation>
    </message>
    <message>
        <source>What the views cover of the image, of tilts and distances, and which to add next.</source>
        <translation>Lo que las vistas abarcan de la imagen, inclinaciones y distancias, y cuál añadir.</translation>
    </message>
    <message>
        <source>Where corners were seen. The lens correction is extrapolated beyond them.</source>
        <translation>Dónde se vieron esquinas. Más allá, la corrección de la lente se extrapola.</translation>
    </message>
    <message>
        <source>tilt to the right</source>
        <translation>inclinación a la derecha</translation>
    </message>
    <message>
        <source>tilt upwards</source>
        <translation>inclinación hacia arriba</translation>
    </message>
    <message>
        <source>Each view&apos;s tilt, towards the side of the board that is farther away.
Points on all sides, 20° to 45° out, determine the focal length best.</source>
        <translation>La inclinación de cada vista, hacia el lado más lejano del tablero.
Puntos a todos los lados, de 20° a 45°, determinan mejor la distancia focal.</translation>
    </message>
    <message>
        <source>view</source>
        <translation>vista</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>distancia</translation>
    </message>
    <message>
        <source>From the camera to the middle of the corners seen.</source>
        <translation>De la cámara al centro de las esquinas vistas.</translation>
    </message>
    <message>
        <source>circles in a cell</source>
        <translation>círculos por celda</translation>
    </message>
    <message>
        <source>corners in a cell</source>
        <translation>esquinas por celda</translation>
    </message>
    <message>
        <source>view (distance in mm{0})</source>
        <translation>vista (distancia en mm{0})</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Which view would help most? Working…</source>
        <translation>¿Qué vista ayudaría más? Calculando…</translation>
    </message>
    <message>
        <source>Looking for the next view</source>
        <translation>Buscando la siguiente vista</translation>
    </message>
    <message>
        <source>Which view would help most was not examined.</source>
        <translation>No se examinó qué vista ayudaría más.</translation>
    </message>
    <message>
        <source>The next view (red): {0} {1}</source>
        <translation>La siguiente vista (rojo): {0} {1}</translation>
    </message>
    <message>
        <source>The next view (red): {0} It hardly lowers the uncertainty of {1} px.</source>
        <translation>La siguiente vista (rojo): {0} Apenas reduce la incertidumbre de {1} px.</translation>
    </message>
    <message>
        <source>The next view (red): {0} It lowers the uncertainty over the image from {1} to {2} px.</source>
        <translation>La siguiente vista (rojo): {0} Reduce la incertidumbre en la imagen de {1} a {2} px.</translation>
    </message>
</context>
<context>
    <name>Detector</name>
    <message>
        <source>Finding corners</source>
        <translation>Buscando esquinas</translation>
    </message>
    <message>
        <source>Detect again</source>
        <translation>Buscar de nuevo</translation>
    </message>
    <message>
        <source>The search was stopped: {0} of {1} images have been searched. Calibrate searches the others.</source>
        <translation>Se detuvo la búsqueda: {0} de {1} imágenes están buscadas. Calibrar busca en las demás.</translation>
    </message>
</context>
<context>
    <name>DifferenceMap</name>
    <message>
        <source>difference [px]</source>
        <translation>diferencia [px]</translation>
    </message>
    <message>
        <source>Distance between a far point&apos;s images by the two calibrations that are compared,
after the rotation that brings the two closest where corners (dots) were seen.</source>
        <translation>Distancia entre las imágenes de un punto lejano en las dos calibraciones comparadas,
tras el giro que más las acerca donde se vieron esquinas (puntos).</translation>
    </message>
    <message>
        <source>The two calibrations do not differ (below {0:g} px).</source>
        <translation>Las dos calibraciones no difieren (menos de {0:g} px).</translation>
    </message>
    <message>
        <source>At most {0} px near corners: point to read it</source>
        <translation>Como mucho {0} px cerca de esquinas: señale para leer</translation>
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
        <translation>Distorsión</translation>
    </message>
    <message>
        <source>How far the lens moves each pixel from where an ideal camera would see it.</source>
        <translation>Cuánto mueve la lente cada píxel de donde lo vería una cámara ideal.</translation>
    </message>
    <message>
        <source>Complete</source>
        <translation>Completa</translation>
    </message>
    <message>
        <source>Radial part</source>
        <translation>Parte radial</translation>
    </message>
    <message>
        <source>Decentering part</source>
        <translation>Descentrado</translation>
    </message>
    <message>
        <source>Part of the distortion</source>
        <translation>Parte de la distorsión</translation>
    </message>
    <message>
        <source>Radial: along rays from the centre. Decentering: from lenses out of line.</source>
        <translation>Radial: a lo largo de rayos desde el centro. Descentrado: de lentes no alineadas.</translation>
    </message>
    <message>
        <source>Only &amp;where corners were seen</source>
        <translation>&amp;Solo donde se vieron esquinas</translation>
    </message>
    <message>
        <source>Beyond the corners&apos; convex hull the correction is an extrapolation.</source>
        <translation>Más allá del contorno de las esquinas la corrección es una extrapolación.</translation>
    </message>
    <message>
        <source>displacement d [px]</source>
        <translation>desplazamiento d [px]</translation>
    </message>
    <message>
        <source>+ array&apos;s centre   × principal point   → gradient</source>
        <translation>+ centro del sensor   × punto principal   → gradiente</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})</source>
        <translation>u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})</translation>
    </message>
    <message>
        <source>d is at most {0} px: point to read it</source>
        <translation>d es como mucho {0} px: señale para leer</translation>
    </message>
</context>
<context>
    <name>DividedImages</name>
    <message>
        <source>Image {0} and {1}</source>
        <translation>Imagen {0} y {1}</translation>
    </message>
    <message>
        <source>Drag the divider, or move it by the arrow keys. The wheel magnifies (+ and −); drag to look around, double-click or 0 for the whole image.</source>
        <translation>Arrastre el divisor o muévalo con las flechas. La rueda amplía (+ y −); arrastre para mirar alrededor, doble clic o 0 para la imagen entera.</translation>
    </message>
</context>
<context>
    <name>DoneList</name>
    <message>
        <source>What was done</source>
        <translation>Qué se hizo</translation>
    </message>
    <message>
        <source>why</source>
        <translation>por qué</translation>
    </message>
    <message>
        <source>Show what speaks for it</source>
        <translation>Mostrar lo que habla a favor</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>Mejorar la cámara</translation>
    </message>
    <message>
        <source>Take this step back; redo brings it again</source>
        <translation>Deshacer este paso; rehacer lo trae de nuevo</translation>
    </message>
    <message>
        <source>undo</source>
        <translation>deshacer</translation>
    </message>
    <message>
        <source>Lens: the paper&apos;s model; no other predicts better</source>
        <translation>Lente: el modelo del artículo; ningún otro predice mejor</translation>
    </message>
    <message>
        <source>Lens: {0}, which predicts best</source>
        <translation>Lente: {0}, que predice mejor</translation>
    </message>
    <message>
        <source>{0} of {1} photographs could not be used: {2}</source>
        <translation>{0} de {1} fotos no se pudieron usar: {2}</translation>
    </message>
    <message>
        <source>Show the photograph</source>
        <translation>Mostrar la foto</translation>
    </message>
</context>
<context>
    <name>ExportDialog</name>
    <message>
        <source>Export</source>
        <translation>Exportar</translation>
    </message>
    <message>
        <source>Formats</source>
        <translation>Formatos</translation>
    </message>
    <message>
        <source>The file&apos;s text</source>
        <translation>El texto del archivo</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Resultado</translation>
    </message>
    <message>
        <source>Read by</source>
        <translation>Lo leen</translation>
    </message>
    <message>
        <source>Keeps</source>
        <translation>Conserva</translation>
    </message>
    <message>
        <source>Loses</source>
        <translation>Pierde</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>Largest error</source>
        <translation>Mayor error</translation>
    </message>
    <message>
        <source>&amp;Copy text</source>
        <translation>&amp;Copiar texto</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Guardar…</translation>
    </message>
    <message>
        <source>Save &amp;all…</source>
        <translation>Guardar &amp;todo…</translation>
    </message>
    <message>
        <source>Every format in a folder, with a page that tells who reads which file</source>
        <translation>Todos los formatos en una carpeta, con una página que dice quién lee cada archivo</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>calculando…</translation>
    </message>
    <message>
        <source>Preparing {0}</source>
        <translation>Preparando {0}</translation>
    </message>
    <message>
        <source>A binary file of {0:.1f} MB</source>
        <translation>Un archivo binario de {0:.1f} MB</translation>
    </message>
    <message>
        <source>none: nothing is refitted</source>
        <translation>ninguno: no se reajusta nada</translation>
    </message>
    <message>
        <source>unlimited in parts of the image that no corner covers</source>
        <translation>ilimitado en partes de la imagen sin esquinas</translation>
    </message>
    <message>
        <source>{0:.3g} px over the whole image</source>
        <translation>{0:.3g} px en toda la imagen</translation>
    </message>
    <message>
        <source>The text is on the clipboard.</source>
        <translation>El texto está en el portapapeles.</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>Escribiendo {0}</translation>
    </message>
    <message>
        <source>Folder for all formats</source>
        <translation>Carpeta para todos los formatos</translation>
    </message>
    <message>
        <source>Writing all formats</source>
        <translation>Escribiendo todos los formatos</translation>
    </message>
    <message>
        <source>{0} of {1} formats are in {2}</source>
        <translation>{0} de {1} formatos están en {2}</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Guardado como {0}</translation>
    </message>
</context>
<context>
    <name>Files</name>
    <message>
        <source>Only the project {0} is opened, without the {1} other files.</source>
        <translation>Solo se abre el proyecto {0}, sin los otros {1} archivos.</translation>
    </message>
    <message>
        <source>Camera file</source>
        <translation>Archivo de cámara</translation>
    </message>
    <message>
        <source>Camera files (*)</source>
        <translation>Archivos de cámara (*)</translation>
    </message>
    <message>
        <source>Not added, as no image can be read there: {0}.</source>
        <translation>No añadido, pues allí no se puede leer ninguna imagen: {0}.</translation>
    </message>
    <message>
        <source>By their names these are photographs of several cameras: {0}. File › Several cameras calibrates each, and how they stand to each other.</source>
        <translation>Por sus nombres, estas son fotografías de varias cámaras: {0}. Archivo › Varias cámaras calibra cada una y cómo están entre sí.</translation>
    </message>
    <message>
        <source>Folder of images</source>
        <translation>Carpeta de imágenes</translation>
    </message>
    <message>
        <source>Add images</source>
        <translation>Añadir imágenes</translation>
    </message>
    <message>
        <source>Images ({0});;All files, also videos (*)</source>
        <translation>Imágenes ({0});;Todos los archivos, también vídeos (*)</translation>
    </message>
    <message>
        <source>Open project</source>
        <translation>Abrir proyecto</translation>
    </message>
    <message>
        <source>Projects (*.json)</source>
        <translation>Proyectos (*.json)</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>Abriendo {0}</translation>
    </message>
    <message>
        <source>Replace the project</source>
        <translation>Sustituir el proyecto</translation>
    </message>
    <message>
        <source>{0} has been saved by another window or program since it was opened here. Replace what is there now?</source>
        <translation>Otra ventana o programa ha guardado {0} desde que se abrió aquí. ¿Sustituir lo que hay ahora?</translation>
    </message>
    <message>
        <source>Save project</source>
        <translation>Guardar proyecto</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>Cambios sin guardar</translation>
    </message>
    <message>
        <source>Save the changes to this project?</source>
        <translation>¿Guardar los cambios de este proyecto?</translation>
    </message>
    <message>
        <source>What you discard is kept for a while in {0}.</source>
        <translation>Lo que descarte queda un tiempo en {0}.</translation>
    </message>
    <message>
        <source>Discard the changes without a copy?</source>
        <translation>¿Descartar los cambios sin copia?</translation>
    </message>
    <message>
        <source>Folder that holds the missing images</source>
        <translation>Carpeta con las imágenes que faltan</translation>
    </message>
    <message>
        <source>Relocate images</source>
        <translation>Reubicar imágenes</translation>
    </message>
    <message>
        <source>Found {0} of {1} missing images in {2}.</source>
        <translation>Se encontraron {0} de {1} imágenes que faltaban en {2}.</translation>
    </message>
    <message>
        <source>Looking for images</source>
        <translation>Buscando imágenes</translation>
    </message>
    <message>
        <source>Rename result</source>
        <translation>Renombrar resultado</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Nombre</translation>
    </message>
    <message>
        <source>Delete {0}</source>
        <translation>Borrar {0}</translation>
    </message>
    <message>
        <source>Folder for the images</source>
        <translation>Carpeta para las imágenes</translation>
    </message>
    <message>
        <source>Writing images</source>
        <translation>Escribiendo imágenes</translation>
    </message>
    <message>
        <source>Wrote {0} images to {1}.</source>
        <translation>{0} imágenes escritas en {1}.</translation>
    </message>
    <message>
        <source>Wrote {0} image to {1}.</source>
        <translation>{0} imagen escrita en {1}.</translation>
    </message>
    <message>
        <source>Replace files</source>
        <translation>Sustituir archivos</translation>
    </message>
    <message>
        <source>In {0} there are files of these names, not written by this program:</source>
        <translation>En {0} hay archivos con estos nombres que no son de este programa:</translation>
    </message>
    <message>
        <source>Replace them?</source>
        <translation>¿Sustituirlos?</translation>
    </message>
</context>
<context>
    <name>FilmStrip</name>
    <message>
        <source>Images</source>
        <translation>Imágenes</translation>
    </message>
    <message>
        <source>Leave the images out whose error is above the threshold</source>
        <translation>Omitir las imágenes cuyo error supera el umbral</translation>
    </message>
    <message>
        <source>Refit at &amp;once</source>
        <translation>&amp;Reajustar al momento</translation>
    </message>
    <message>
        <source>Calibrate again at once when images are excluded or included. The shown result is replaced; undo brings it back.</source>
        <translation>Calibrar de nuevo al momento cuando se omiten o incluyen imágenes. El resultado mostrado se sustituye; deshacer lo trae de nuevo.</translation>
    </message>
    <message>
        <source>Sort by &amp;name</source>
        <translation>Ordenar por &amp;nombre</translation>
    </message>
    <message>
        <source>Sort by &amp;status</source>
        <translation>Ordenar por &amp;estado</translation>
    </message>
    <message>
        <source>Sort by lar&amp;gest error</source>
        <translation>Ordenar por &amp;mayor error</translation>
    </message>
    <message>
        <source>Put the images in this order</source>
        <translation>Poner las imágenes en este orden</translation>
    </message>
    <message>
        <source>Include {0}</source>
        <translation>Incluir {0}</translation>
    </message>
    <message>
        <source>Exclude {0}</source>
        <translation>Omitir {0}</translation>
    </message>
    <message>
        <source>Remove {0}</source>
        <translation>Quitar {0}</translation>
    </message>
    <message>
        <source>{0} images</source>
        <translation>{0} imágenes</translation>
    </message>
    <message>
        <source>Ex&amp;clude or include</source>
        <translation>&amp;Omitir o incluir</translation>
    </message>
    <message>
        <source>Leave the selected images out of the calibration, or take them in again.</source>
        <translation>Omitir las imágenes elegidas en la calibración, o incluirlas de nuevo.</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>&amp;Buscar de nuevo</translation>
    </message>
    <message>
        <source>Forget what was found in the selected images and search them anew.</source>
        <translation>Olvidar lo encontrado en las imágenes elegidas y buscar otra vez.</translation>
    </message>
    <message>
        <source>&amp;Remove from project</source>
        <translation>&amp;Quitar del proyecto</translation>
    </message>
    <message>
        <source>Take the selected images out of the project. The files stay.</source>
        <translation>Sacar las imágenes elegidas del proyecto. Los archivos quedan.</translation>
    </message>
    <message>
        <source>No image is selected in the list.</source>
        <translation>No hay ninguna imagen elegida en la lista.</translation>
    </message>
    <message>
        <source>{0} px: {1} above · leave out</source>
        <translation>{0} px: {1} por encima · omitir</translation>
    </message>
    <message>
        <source>{0} px: all are above</source>
        <translation>{0} px: todas por encima</translation>
    </message>
    <message>
        <source>{0} px: none above</source>
        <translation>{0} px: ninguna por encima</translation>
    </message>
</context>
<context>
    <name>FindingRow</name>
    <message>
        <source>{0} times better once mended</source>
        <translation>{0} veces mejor una vez corregido</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Detalles</translation>
    </message>
    <message>
        <source>Show the figures and what to do</source>
        <translation>Mostrar las cifras y qué hacer</translation>
    </message>
    <message>
        <source>Show the evidence</source>
        <translation>Mostrar la prueba</translation>
    </message>
</context>
<context>
    <name>FleetDialog</name>
    <message>
        <source>Fleet {0}</source>
        <translation>Flota {0}</translation>
    </message>
    <message>
        <source>{0} cameras. Failing: {1}. Unlike the others of their image size and lens model: {2}. Changed: {3}.</source>
        <translation>{0} cámaras. No pasan: {1}. Distintas de las demás de su tamaño de imagen y modelo de lente: {2}. Cambiadas: {3}.</translation>
    </message>
    <message>
        <source>Camera, serial number, reason…</source>
        <translation>Cámara, número de serie, motivo…</translation>
    </message>
    <message>
        <source>Filter</source>
        <translation>Filtro</translation>
    </message>
    <message>
        <source>Which cameras are shown</source>
        <translation>Qué cámaras se muestran</translation>
    </message>
    <message>
        <source>all</source>
        <translation>todas</translation>
    </message>
    <message>
        <source>failing</source>
        <translation>no pasan</translation>
    </message>
    <message>
        <source>unlike the others</source>
        <translation>distintas de las demás</translation>
    </message>
    <message>
        <source>changed</source>
        <translation>cambiadas</translation>
    </message>
    <message>
        <source>First photograph of the camera</source>
        <translation>Primera foto de la cámara</translation>
    </message>
    <message>
        <source>&amp;Open camera</source>
        <translation>&amp;Abrir cámara</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Número de serie</translation>
    </message>
    <message>
        <source>Date</source>
        <translation>Fecha</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Veredicto</translation>
    </message>
    <message>
        <source>pass</source>
        <translation>pasa</translation>
    </message>
    <message>
        <source>fail</source>
        <translation>no pasa</translation>
    </message>
    <message>
        <source>Whether the camera keeps the limits of its fleet</source>
        <translation>Si la cámara cumple los límites de su flota</translation>
    </message>
    <message>
        <source>Views</source>
        <translation>Vistas</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Root mean square residual</source>
        <translation>Residuo cuadrático medio</translation>
    </message>
    <message>
        <source>Standard deviation of one coordinate of a corner</source>
        <translation>Desviación estándar de una coordenada de una esquina</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Esquinas</translation>
    </message>
    <message>
        <source>Error, edge</source>
        <translation>Error, borde</translation>
    </message>
    <message>
        <source>Error of a pixel at the image&apos;s edge, one standard deviation</source>
        <translation>Error de un píxel en el borde de la imagen, una desviación estándar</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Diferencia</translation>
    </message>
    <message>
        <source>Distance from the median camera of the same image size and lens model, rms over the image, after the rotation that brings both together</source>
        <translation>Distancia a la cámara mediana del mismo tamaño de imagen y modelo de lente, RMS en la imagen, tras el giro que las junta</translation>
    </message>
    <message>
        <source>In σ</source>
        <translation>En σ</translation>
    </message>
    <message>
        <source>The difference in standard deviations of the fleet</source>
        <translation>La diferencia en desviaciones estándar de la flota</translation>
    </message>
    <message>
        <source>Changed by</source>
        <translation>Cambió en</translation>
    </message>
    <message>
        <source>Difference from the last calibration of the serial number</source>
        <translation>Diferencia con la última calibración del número de serie</translation>
    </message>
    <message>
        <source>It is unlike the others of its kind.</source>
        <translation>Es distinta de las demás de su clase.</translation>
    </message>
    <message>
        <source>It has changed since {0}, by {1:.2g} px at most.</source>
        <translation>Ha cambiado desde {0}, en {1:.2g} px como mucho.</translation>
    </message>
    <message>
        <source>It passes.</source>
        <translation>Pasa.</translation>
    </message>
</context>
<context>
    <name>GlassRow</name>
    <message>
        <source>If the board is of glass, printed true to {0:g} mm and flat to {1:g} mm: {2} px.</source>
        <translation>Si el tablero es de vidrio, impreso a {0:g} mm y plano a {1:g} mm: {2} px.</translation>
    </message>
    <message>
        <source>It is of glass</source>
        <translation>Es de vidrio</translation>
    </message>
</context>
<context>
    <name>GoodSet</name>
    <message>
        <source>filling the image</source>
        <translation>llena la imagen</translation>
    </message>
    <message>
        <source>tilted back</source>
        <translation>inclinado atrás</translation>
    </message>
    <message>
        <source>tilted to a side</source>
        <translation>inclinado a un lado</translation>
    </message>
    <message>
        <source>in one corner</source>
        <translation>en una esquina</translation>
    </message>
    <message>
        <source>in the others</source>
        <translation>en las otras</translation>
    </message>
    <message>
        <source>turned upright</source>
        <translation>girado</translation>
    </message>
    <message>
        <source>A good set of photographs</source>
        <translation>Un buen conjunto de fotos</translation>
    </message>
    <message>
        <source>10 to 20 of one flat board: sharp, evenly lit, with the focus and zoom that the camera will have at work.</source>
        <translation>De 10 a 20 de un tablero plano: nítidas, con luz uniforme, con el enfoque y el zoom con que trabajará la cámara.</translation>
    </message>
</context>
<context>
    <name>HandEyeDialog</name>
    <message>
        <source>Hand and eye</source>
        <translation>Mano y ojo</translation>
    </message>
    <message>
        <source>Robot&apos;s &amp;poses…</source>
        <translation>&amp;Poses del robot…</translation>
    </message>
    <message>
        <source>CSV, JSON, text or MAT: a pose for each photograph, by its name or in their order, in any units and convention</source>
        <translation>CSV, JSON, texto o MAT: una pose por foto, por su nombre o en su orden, en cualquier unidad y convención</translation>
    </message>
    <message>
        <source>Where the camera is</source>
        <translation>Dónde está la cámara</translation>
    </message>
    <message>
        <source>as the poses tell</source>
        <translation>según las poses</translation>
    </message>
    <message>
        <source>in the hand</source>
        <translation>en la mano</translation>
    </message>
    <message>
        <source>beside the robot</source>
        <translation>junto al robot</translation>
    </message>
    <message>
        <source>The tool&apos;s point in the hand&apos;s frame</source>
        <translation>El punto de la herramienta en el sistema de la mano</translation>
    </message>
    <message>
        <source>X, Y, Z: the board</source>
        <translation>X, Y, Z: el tablero</translation>
    </message>
    <message>
        <source>Where ± is stated, as 0, 0, 120; if empty, it is where the board was</source>
        <translation>Dónde se indica ±, como 0, 0, 120; si está vacío, donde estaba el tablero</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Guardar…</translation>
    </message>
    <message>
        <source>Choose the file of the poses at which the robot stood for the photographs.</source>
        <translation>Elija el archivo de las poses en que estaba el robot para las fotos.</translation>
    </message>
    <message>
        <source>The side of a square is not known, and the robot&apos;s poses have lengths. Close this, and answer in the window how long the squares are.</source>
        <translation>No se conoce el lado de un cuadro, y las poses del robot tienen longitudes. Cierre esto y responda en la ventana cuánto miden los cuadros.</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>Tool at</source>
        <translation>Herramienta en</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Poses of the robot</source>
        <translation>Poses del robot</translation>
    </message>
    <message>
        <source>Poses (*.csv *.json *.txt *.mat);;All files (*)</source>
        <translation>Poses (*.csv *.json *.txt *.mat);;Todos los archivos (*)</translation>
    </message>
    <message>
        <source>{0} is no point X, Y, Z, such as 0, 0, 120.</source>
        <translation>{0} no es un punto X, Y, Z, como 0, 0, 120.</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>calculando…</translation>
    </message>
    <message>
        <source>Finding hand and eye</source>
        <translation>Buscando mano y ojo</translation>
    </message>
    <message>
        <source>Camera in the hand</source>
        <translation>Cámara en la mano</translation>
    </message>
    <message>
        <source>Board in the base</source>
        <translation>Tablero en la base</translation>
    </message>
    <message>
        <source>Camera in the base</source>
        <translation>Cámara en la base</translation>
    </message>
    <message>
        <source>Board in the hand</source>
        <translation>Tablero en la mano</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>rotation vector, {0}</source>
        <translation>vector de rotación, {0}</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Unidad</translation>
    </message>
    <message>
        <source>degrees</source>
        <translation>grados</translation>
    </message>
    <message>
        <source>The most likely error of the robot&apos;s pose</source>
        <translation>El error más probable de la pose del robot</translation>
    </message>
    <message>
        <source>Photograph</source>
        <translation>Foto</translation>
    </message>
    <message>
        <source>Robot off by</source>
        <translation>Desvío del robot</translation>
    </message>
    <message>
        <source>Turned by</source>
        <translation>Girado en</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>Usado</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>omitido</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>sí</translation>
    </message>
    <message>
        <source>&amp;Use again</source>
        <translation>&amp;Usar de nuevo</translation>
    </message>
    <message>
        <source>&amp;Leave out</source>
        <translation>&amp;Omitir</translation>
    </message>
    <message>
        <source>Save hand and eye</source>
        <translation>Guardar mano y ojo</translation>
    </message>
    <message>
        <source>Hand and eye (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</source>
        <translation>Mano y ojo (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>Escribiendo {0}</translation>
    </message>
    <message>
        <source>Saved as {0}.</source>
        <translation>Guardado como {0}.</translation>
    </message>
</context>
<context>
    <name>Header</name>
    <message>
        <source>Set-up</source>
        <translation>Ajustes</translation>
    </message>
    <message>
        <source>The board, the lens, and how to calibrate</source>
        <translation>El tablero, la lente y cómo calibrar</translation>
    </message>
    <message>
        <source>Report…</source>
        <translation>Informe…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page (Ctrl+P)</source>
        <translation>Escribir lo que se sabe como PDF o página web (Ctrl+P)</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>Exportar…</translation>
    </message>
    <message>
        <source>Write the camera for another program (Ctrl+E)</source>
        <translation>Escribir la cámara para otro programa (Ctrl+E)</translation>
    </message>
    <message>
        <source>Show the verdict, or hide it again</source>
        <translation>Mostrar el veredicto, u ocultarlo de nuevo</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Sin nombre</translation>
    </message>
    <message>
        <source>1 photograph</source>
        <translation>1 fotografía</translation>
    </message>
    <message>
        <source>{0} photographs</source>
        <translation>{0} fotos</translation>
    </message>
    <message>
        <source>{0} of {1} photographs usable</source>
        <translation>{0} de {1} fotos utilizables</translation>
    </message>
</context>
<context>
    <name>HistogramPlot</name>
    <message>
        <source>density</source>
        <translation>densidad</translation>
    </message>
    <message>
        <source>Rayleigh s</source>
        <translation>Rayleigh s</translation>
    </message>
    <message>
        <source>Gaussian σ</source>
        <translation>Gauss σ</translation>
    </message>
    <message>
        <source>mean {0:.4f}, SD {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</source>
        <translation>media {0:.4f}, DE {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</translation>
    </message>
    <message>
        <source>; {0} farther out</source>
        <translation>; {0} más lejos</translation>
    </message>
</context>
<context>
    <name>Histograms</name>
    <message>
        <source>Component of the residuals</source>
        <translation>Componente de los residuos</translation>
    </message>
    <message>
        <source>The residuals&apos; components on the reference plane, or their length e′.</source>
        <translation>Las componentes de los residuos en el plano de referencia, o su longitud e′.</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>px de referencia</translation>
    </message>
    <message>
        <source>{0}, real</source>
        <translation>{0}, real</translation>
    </message>
    <message>
        <source>{0}, synthetic</source>
        <translation>{0}, sintético</translation>
    </message>
</context>
<context>
    <name>HistogramsPanel</name>
    <message>
        <source>Histograms</source>
        <translation>Histogramas</translation>
    </message>
    <message>
        <source>How the residuals are distributed, beside a Gaussian and a Rayleigh distribution.</source>
        <translation>Cómo se reparten los residuos, junto a una distribución de Gauss y una de Rayleigh.</translation>
    </message>
    <message>
        <source>Noise of equal size in all directions has Gaussian components and lengths after Rayleigh.
Heavy tails mean bad corners; two humps, a board that is not flat or a wrong model.</source>
        <translation>El ruido igual en todas direcciones tiene componentes de Gauss y longitudes de Rayleigh.
Colas pesadas indican malas esquinas; dos jorobas, un tablero no plano o un modelo erróneo.</translation>
    </message>
</context>
<context>
    <name>ImageModel</name>
    <message>
        <source>changed · {0}</source>
        <translation>cambiada · {0}</translation>
    </message>
    <message>
        <source>{0}, error {1:.3f} px</source>
        <translation>{0}, error {1:.3f} px</translation>
    </message>
    <message>
        <source>The file has changed since its corners were found: detect again.</source>
        <translation>El archivo ha cambiado desde que se encontraron sus esquinas: busque de nuevo.</translation>
    </message>
</context>
<context>
    <name>ImagePage</name>
    <message>
        <source>Tools</source>
        <translation>Herramientas</translation>
    </message>
    <message>
        <source>Layers</source>
        <translation>Capas</translation>
    </message>
    <message>
        <source>Choose what is drawn over the image</source>
        <translation>Elegir lo que se dibuja sobre la imagen</translation>
    </message>
    <message>
        <source>&amp;Mark board</source>
        <translation>&amp;Marcar tablero</translation>
    </message>
    <message>
        <source>Point at the board&apos;s four outermost corners</source>
        <translation>Señale las cuatro esquinas extremas del tablero</translation>
    </message>
    <message>
        <source>&amp;Edit corners</source>
        <translation>&amp;Editar esquinas</translation>
    </message>
    <message>
        <source>Move, remove and restore single corners; turn the axes</source>
        <translation>Mover, quitar y recuperar esquinas; girar los ejes</translation>
    </message>
    <message>
        <source>Mark</source>
        <translation>Marcar</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>Editar</translation>
    </message>
    <message>
        <source>&amp;Fit</source>
        <translation>&amp;Encajar</translation>
    </message>
    <message>
        <source>Show the whole image</source>
        <translation>Mostrar la imagen entera</translation>
    </message>
    <message>
        <source>&amp;1:1</source>
        <translation>&amp;1:1</translation>
    </message>
    <message>
        <source>Show the image&apos;s pixels as pixels of the screen</source>
        <translation>Mostrar los píxeles de la imagen como píxeles de la pantalla</translation>
    </message>
    <message>
        <source>No image is shown that can be read.</source>
        <translation>No se muestra ninguna imagen legible.</translation>
    </message>
    <message>
        <source>, {0} px</source>
        <translation>, {0} px</translation>
    </message>
    <message>
        <source>corner in row {0}, column {1}: u {2:.3f}, v {3:.3f} px</source>
        <translation>esquina en fila {0}, columna {1}: u {2:.3f}, v {3:.3f} px</translation>
    </message>
    <message>
        <source>; residual Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px</source>
        <translation>; residuo Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px</translation>
    </message>
    <message>
        <source>u {0:.2f}  v {1:.2f} px</source>
        <translation>u {0:.2f}  v {1:.2f} px</translation>
    </message>
    <message>
        <source>   grey {0}</source>
        <translation>   gris {0}</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its place</source>
        <translation>   esquina: fila {0}, columna {1}; pulse para ver su lugar</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its residual</source>
        <translation>   esquina: fila {0}, columna {1}; pulse para ver su residuo</translation>
    </message>
</context>
<context>
    <name>Inspector</name>
    <message>
        <source>Is the camera still good?

Drop new photographs of the board here: they check it and change nothing.

Dropped on the left they join the project.</source>
        <translation>¿Sigue siendo buena la cámara?

Suelte aquí fotos nuevas del tablero: la comprueban y no cambian nada.

Soltadas a la izquierda entran en el proyecto.</translation>
    </message>
</context>
<context>
    <name>InstantView</name>
    <message>
        <source>Photographs of an instant</source>
        <translation>Fotos de un instante</translation>
    </message>
</context>
<context>
    <name>KnownCameraChoice</name>
    <message>
        <source>calibrated</source>
        <translation>calibrada</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>Elegir…</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>Calibrar de nuevo</translation>
    </message>
    <message>
        <source>Hold the camera of a file of this or another program, and locate the board in photographs with it. Such a file can also be dropped on the window.</source>
        <translation>Fijar la cámara de un archivo de este u otro programa, y ubicar con ella el tablero en las fotos. Un archivo así también se puede soltar en la ventana.</translation>
    </message>
    <message>
        <source>Give the camera of the file up: calibrate one from the photographs.</source>
        <translation>Renunciar a la cámara del archivo: calibrar una con las fotos.</translation>
    </message>
</context>
<context>
    <name>KnownCameras</name>
    <message>
        <source>Known camera</source>
        <translation>Cámara conocida</translation>
    </message>
    <message>
        <source>The camera of {0} ({1}) stays as it is: Calibrate only finds where the board was. To calibrate another, take it away in the Set-up.</source>
        <translation>La cámara de {0} ({1}) queda como está: Calibrar solo busca dónde estaba el tablero. Para calibrar otra, quítela en Ajustes.</translation>
    </message>
    <message>
        <source>Of {0} camera files it is the first.</source>
        <translation>De {0} archivos de cámara es el primero.</translation>
    </message>
</context>
<context>
    <name>LayerMenu</name>
    <message>
        <source>Residuals × </source>
        <translation>Residuos × </translation>
    </message>
    <message>
        <source>How many times as long as they are residuals are drawn</source>
        <translation>Cuántas veces más largos de lo que son se dibujan los residuos</translation>
    </message>
    <message>
        <source>Magnification of residuals</source>
        <translation>Ampliación de los residuos</translation>
    </message>
    <message>
        <source>&amp;Region of interest</source>
        <translation>&amp;Región de interés</translation>
    </message>
    <message>
        <source>The part of the image that was searched (yellow outline)</source>
        <translation>La parte de la imagen en que se buscó (contorno amarillo)</translation>
    </message>
    <message>
        <source>First &amp;estimates</source>
        <translation>Primeras &amp;estimaciones</translation>
    </message>
    <message>
        <source>Corners to the nearest pixel, by Harris&apos; detector (red +)</source>
        <translation>Esquinas al píxel más próximo, con el detector de Harris (+ rojo)</translation>
    </message>
    <message>
        <source>Refi&amp;ned corners</source>
        <translation>Esquinas re&amp;finadas</translation>
    </message>
    <message>
        <source>Corners at the saddle point of the grey levels (yellow +)</source>
        <translation>Esquinas en el punto de silla de los niveles de gris (+ amarillo)</translation>
    </message>
    <message>
        <source>&amp;Order and axes</source>
        <translation>&amp;Orden y ejes</translation>
    </message>
    <message>
        <source>The numbering of the corners: origin, rows, and the board&apos;s axes</source>
        <translation>La numeración de las esquinas: origen, filas y ejes del tablero</translation>
    </message>
    <message>
        <source>Re&amp;projection</source>
        <translation>Re&amp;proyección</translation>
    </message>
    <message>
        <source>Where the calibration expects the corners (blue circles)</source>
        <translation>Dónde espera la calibración las esquinas (círculos azules)</translation>
    </message>
    <message>
        <source>Re&amp;siduals</source>
        <translation>Re&amp;siduos</translation>
    </message>
    <message>
        <source>Arrows from expected to measured corners, magnified</source>
        <translation>Flechas de las esquinas esperadas a las medidas, ampliadas</translation>
    </message>
</context>
<context>
    <name>LensModelsPanel</name>
    <message>
        <source>Lens models</source>
        <translation>Modelos de lente</translation>
    </message>
    <message>
        <source>All lens models on the same corners, by what they predict of unseen views.</source>
        <translation>Todos los modelos de lente con las mismas esquinas, según lo que predicen de vistas no vistas.</translation>
    </message>
    <message>
        <source>C&amp;ompare lens models</source>
        <translation>C&amp;omparar modelos de lente</translation>
    </message>
    <message>
        <source>Calibrates every lens model from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>Calibra cada modelo de lente con estas vistas, y otra vez sin algunas, para ver cómo predice lo que no ha visto. Tarda un rato.</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>Comparando modelos de lente</translation>
    </message>
    <message>
        <source>Calibrating every lens model several times…</source>
        <translation>Calibrando cada modelo de lente varias veces…</translation>
    </message>
    <message>
        <source>&amp;Use this model</source>
        <translation>&amp;Usar este modelo</translation>
    </message>
    <message>
        <source>Set the selected lens model in the Set-up and calibrate.</source>
        <translation>Poner el modelo de lente elegido en los Ajustes y calibrar.</translation>
    </message>
    <message>
        <source>The views do not determine the camera: lens models cannot be compared on them.</source>
        <translation>Las vistas no determinan la cámara: no se pueden comparar modelos de lente con ellas.</translation>
    </message>
    <message>
        <source>This result is of the lens model {0}. Does another one do better?</source>
        <translation>Este resultado es del modelo de lente {0}. ¿Hay otro mejor?</translation>
    </message>
    <message>
        <source>{0} cannot be calibrated: {1}</source>
        <translation>{0} no se puede calibrar: {1}</translation>
    </message>
    <message>
        <source>{0}: RMS {1:.3f} px, σx {2:.3f} px and σy {3:.3f} px of {4}.</source>
        <translation>{0}: RMS {1:.3f} px, σx {2:.3f} px y σy {3:.3f} px de {4}.</translation>
    </message>
</context>
<context>
    <name>LensTables</name>
    <message>
        <source>Errors</source>
        <translation>Errores</translation>
    </message>
    <message>
        <source>Image</source>
        <translation>Imagen</translation>
    </message>
    <message>
        <source>n</source>
        <translation>n</translation>
    </message>
    <message>
        <source>Estimated parameters</source>
        <translation>Parámetros estimados</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>Residuos de una calibración con todas las vistas</translation>
    </message>
    <message>
        <source>σx</source>
        <translation>σx</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals across the image</source>
        <translation>Desviación estándar de estos residuos a lo ancho de la imagen</translation>
    </message>
    <message>
        <source>σy</source>
        <translation>σy</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals down the image</source>
        <translation>Desviación estándar de estos residuos a lo alto de la imagen</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>No vistas</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>RMS de los residuos de vistas que se omitieron por turno,
ajustando solo sus poses</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>Mediana</translation>
    </message>
    <message>
        <source>Median length of the residuals of unseen views</source>
        <translation>Longitud mediana de los residuos de vistas no vistas</translation>
    </message>
    <message>
        <source>95 %</source>
        <translation>95 %</translation>
    </message>
    <message>
        <source>Length that 95 % of the residuals of unseen views do not exceed</source>
        <translation>Longitud que el 95 % de los residuos de vistas no vistas no supera</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Notas</translation>
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
        <translation>Vertical</translation>
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
        <translation>Campo de visión, {0}, grados</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Esquinas</translation>
    </message>
    <message>
        <source>Largest angle off the axis at which a corner was seen, degrees</source>
        <translation>Mayor ángulo con el eje en que se vio una esquina, grados</translation>
    </message>
    <message>
        <source>BIC</source>
        <translation>BIC</translation>
    </message>
    <message>
        <source>Bayesian information criterion, less the least one</source>
        <translation>Criterio de información bayesiano, menos el menor</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>Difiere</translation>
    </message>
    <message>
        <source>Largest distance from the recommended model&apos;s map where corners were seen</source>
        <translation>Mayor distancia al mapa del modelo recomendado donde se vieron esquinas</translation>
    </message>
    <message>
        <source>Valid</source>
        <translation>Válido</translation>
    </message>
    <message>
        <source>Part of the image on which the map is one-to-one</source>
        <translation>Parte de la imagen en que el mapa es unívoco</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>Modelo de lente</translation>
    </message>
</context>
<context>
    <name>LimitsChoice</name>
    <message>
        <source>Limits</source>
        <translation>Límites</translation>
    </message>
    <message>
        <source>What a calibration has to keep, as for a fleet: the verdict stays as it is.</source>
        <translation>Lo que una calibración debe cumplir, como en una flota: el veredicto queda como está.</translation>
    </message>
    <message>
        <source>nothing is demanded</source>
        <translation>no se exige nada</translation>
    </message>
    <message>
        <source>from a file…</source>
        <translation>de un archivo…</translation>
    </message>
    <message>
        <source>With limits the verdict says PASS or FAIL, as for a fleet&apos;s cameras.</source>
        <translation>Con límites, el veredicto dice PASS o FAIL, como con las cámaras de una flota.</translation>
    </message>
    <message>
        <source>Limits (*.toml)</source>
        <translation>Límites (*.toml)</translation>
    </message>
    <message>
        <source>error of a pixel at the edge: at most {0:g} px</source>
        <translation>error de un píxel en el borde: como mucho {0:g} px</translation>
    </message>
    <message>
        <source>photographs: at least {0:g}</source>
        <translation>fotos: al menos {0:g}</translation>
    </message>
    <message>
        <source>of the sensor with corners: at least {0:g} %</source>
        <translation>del sensor con esquinas: al menos {0:g} %</translation>
    </message>
    <message>
        <source>lengths of {0:g} mm at {1:g} mm: ± {2:g} mm at most</source>
        <translation>longitudes de {0:g} mm a {1:g} mm: ± {2:g} mm como mucho</translation>
    </message>
</context>
<context>
    <name>LimitsRow</name>
    <message>
        <source>Limits</source>
        <translation>Límites</translation>
    </message>
    <message>
        <source>FAIL by the limits {0}. {1}</source>
        <translation>FAIL según los límites {0}. {1}</translation>
    </message>
    <message>
        <source>PASS by the limits {0}.</source>
        <translation>PASS según los límites {0}.</translation>
    </message>
</context>
<context>
    <name>LivePage</name>
    <message>
        <source>Choose a camera, and press Start.</source>
        <translation>Elija una cámara y pulse Iniciar.</translation>
    </message>
    <message>
        <source>as the camera has it</source>
        <translation>como la tiene la cámara</translation>
    </message>
    <message>
        <source>{0} × {1} px</source>
        <translation>{0} × {1} px</translation>
    </message>
    <message>
        <source>Exposure, the same in all pictures</source>
        <translation>Exposición, la misma en todas las imágenes</translation>
    </message>
    <message>
        <source>Focus, the same in all pictures</source>
        <translation>Enfoque, el mismo en todas las imágenes</translation>
    </message>
    <message>
        <source>{0}, in the camera&apos;s own unit, of a camera at this computer</source>
        <translation>{0}, en la unidad de la cámara, de una cámara de este equipo</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>It ends when the camera puts no pixel farther off, one standard deviation</source>
        <translation>Termina cuando la cámara no desvía más ningún píxel, una desviación estándar</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>Elegir…</translation>
    </message>
    <message>
        <source>A &amp;sound for each picture</source>
        <translation>Un &amp;sonido por foto</translation>
    </message>
    <message>
        <source>&amp;Start</source>
        <translation>&amp;Iniciar</translation>
    </message>
    <message>
        <source>&amp;Take it now (space)</source>
        <translation>&amp;Tomar ahora (espacio)</translation>
    </message>
    <message>
        <source>&amp;Finish</source>
        <translation>&amp;Terminar</translation>
    </message>
    <message>
        <source>&amp;Calibrate with these</source>
        <translation>&amp;Calibrar con estas</translation>
    </message>
    <message>
        <source>&amp;Go on</source>
        <translation>&amp;Seguir</translation>
    </message>
    <message>
        <source>&amp;Leave</source>
        <translation>Sa&amp;lir</translation>
    </message>
    <message>
        <source>%p % of the way to the yellow place</source>
        <translation>%p % del camino al lugar amarillo</translation>
    </message>
    <message>
        <source>as it is</source>
        <translation>como está</translation>
    </message>
    <message>
        <source>Camera, address or folder</source>
        <translation>Cámara, dirección o carpeta</translation>
    </message>
    <message>
        <source>Size of its images</source>
        <translation>Tamaño de sus imágenes</translation>
    </message>
    <message>
        <source>Exposure</source>
        <translation>Exposición</translation>
    </message>
    <message>
        <source>Focus</source>
        <translation>Enfoque</translation>
    </message>
    <message>
        <source>Until the worst pixel is known to</source>
        <translation>Hasta conocer el peor píxel a</translation>
    </message>
    <message>
        <source>Pictures are written to</source>
        <translation>Las fotos se escriben en</translation>
    </message>
    <message>
        <source>Hold the whole board in the picture: its kind and size are found. The yellow shape shows where it is wanted next. When it is still, sharp and worth it, the picture is taken by itself; every fifth one is put aside to check the camera with. No board at hand? Calibration › Print a board shows one on a screen.</source>
        <translation>Sostenga el tablero entero en la imagen: su clase y tamaño se averiguan. La forma amarilla muestra dónde ponerlo ahora. Cuando está quieto, nítido y merece la pena, la foto se toma sola; una de cada cinco se aparta para comprobar la cámara. ¿Sin tablero a mano? Calibración › Imprimir un tablero muestra uno en pantalla.</translation>
    </message>
    <message>
        <source>Photograph live</source>
        <translation>Fotografiar en vivo</translation>
    </message>
    <message>
        <source>Opening…</source>
        <translation>Abriendo…</translation>
    </message>
    <message>
        <source>Pictures put aside are predicted to {0} px rms ({1} corners).</source>
        <translation>Las fotos apartadas se predicen a {0} px RMS ({1} esquinas).</translation>
    </message>
    <message>
        <source>Nothing was taken.</source>
        <translation>No se tomó nada.</translation>
    </message>
    <message>
        <source>Done: known well enough.</source>
        <translation>Listo: se conoce lo bastante bien.</translation>
    </message>
    <message>
        <source>Stopped. More pictures would help.</source>
        <translation>Detenido. Más fotos ayudarían.</translation>
    </message>
    <message>
        <source>Folder for the pictures</source>
        <translation>Carpeta para las fotos</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Live image</source>
        <translation>Imagen en vivo</translation>
    </message>
</context>
<context>
    <name>LiveViews</name>
    <message>
        <source>Live image</source>
        <translation type="unfinished">Imagen en vivo</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>C&amp;alibrate</source>
        <translation>C&amp;alibrar</translation>
    </message>
    <message>
        <source>Find the corners still missing, then estimate the camera</source>
        <translation>Buscar las esquinas que faltan y luego estimar la cámara</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>Ajustes</translation>
    </message>
    <message>
        <source>The program has met an error again: {0}.</source>
        <translation>El programa ha vuelto a encontrar un error: {0}.</translation>
    </message>
    <message>
        <source>Save the project, and start the program anew.</source>
        <translation>Guarde el proyecto y arranque el programa de nuevo.</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Sin nombre</translation>
    </message>
</context>
<context>
    <name>ManualDialog</name>
    <message>
        <source>Manual</source>
        <translation>Manual</translation>
    </message>
    <message>
        <source>Chapters</source>
        <translation>Capítulos</translation>
    </message>
    <message>
        <source>Chapter</source>
        <translation>Capítulo</translation>
    </message>
    <message>
        <source>Open in the &amp;browser</source>
        <translation>Abrir en el &amp;navegador</translation>
    </message>
    <message>
        <source>All chapters as one page, to search and to print</source>
        <translation>Todos los capítulos en una página, para buscar e imprimir</translation>
    </message>
</context>
<context>
    <name>ManyCameras</name>
    <message>
        <source>Open fleet</source>
        <translation>Abrir flota</translation>
    </message>
    <message>
        <source>Fleets (*.db)</source>
        <translation>Flotas (*.db)</translation>
    </message>
    <message>
        <source>Reading {0}</source>
        <translation>Leyendo {0}</translation>
    </message>
</context>
<context>
    <name>Marker</name>
    <message>
        <source>Turn axes</source>
        <translation>Girar ejes</translation>
    </message>
    <message>
        <source>Flip axes</source>
        <translation>Voltear ejes</translation>
    </message>
    <message>
        <source>Click the four outermost {1}, going round the board: {0} of 4.</source>
        <translation>Pulse los cuatro {1} extremos, alrededor del tablero: {0} de 4.</translation>
    </message>
    <message>
        <source> Backspace takes one back.</source>
        <translation> Retroceso quita uno.</translation>
    </message>
    <message>
        <source>Counting…</source>
        <translation>Contando…</translation>
    </message>
    <message>
        <source>{0} of {1} corners. Enter accepts; drag a handle to change them.</source>
        <translation>{0} de {1} esquinas. Intro las acepta; arrastre un tirador para cambiarlas.</translation>
    </message>
    <message>
        <source> The other images show {0} × {1}.</source>
        <translation> Las otras imágenes muestran {0} × {1}.</translation>
    </message>
    <message>
        <source>This image has {0} × {1} pixels, the others {2} × {3}.</source>
        <translation>Esta imagen tiene {0} × {1} píxeles, las otras {2} × {3}.</translation>
    </message>
    <message>
        <source>Calibrate images of each size by themselves.</source>
        <translation>Calibre por separado las imágenes de cada tamaño.</translation>
    </message>
    <message>
        <source>Mark board</source>
        <translation>Marcar tablero</translation>
    </message>
    <message>
        <source>Move corner</source>
        <translation>Mover esquina</translation>
    </message>
    <message>
        <source>Remove corner</source>
        <translation>Quitar esquina</translation>
    </message>
    <message>
        <source>Restore corner</source>
        <translation>Recuperar esquina</translation>
    </message>
</context>
<context>
    <name>Matrix</name>
    <message>
        <source>correlation of {0} and {1}: {2:+.4f}</source>
        <translation>correlación de {0} y {1}: {2:+.4f}</translation>
    </message>
</context>
<context>
    <name>MethodChoice</name>
    <message>
        <source>Method</source>
        <translation>Método</translation>
    </message>
</context>
<context>
    <name>MethodTables</name>
    <message>
        <source>Errors</source>
        <translation>Errores</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>It knows no lengths: this is the distance of corners from straight rows and columns.
Compare it with methods marked * only.</source>
        <translation>No conoce longitudes: esta es la distancia de las esquinas a filas y columnas rectas.
Compárelo solo con métodos marcados con *.</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>Residuos de una calibración con todas las vistas</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate of these residuals</source>
        <translation>Desviación típica de una coordenada de estos residuos</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>No vistas</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>RMS de los residuos de vistas que se omitieron por turno,
ajustando solo sus poses</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>Difiere</translation>
    </message>
    <message>
        <source>Largest distance between a point&apos;s images by this method and by the chosen
calibration, where corners were seen</source>
        <translation>Mayor distancia entre las imágenes de un punto con este método y con la calibración
elegida, donde se vieron esquinas</translation>
    </message>
    <message>
        <source>in RMS</source>
        <translation>en RMS</translation>
    </message>
    <message>
        <source>Root mean square of these distances</source>
        <translation>Media cuadrática de estas distancias</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Pasos</translation>
    </message>
    <message>
        <source>Iterations of the refinement; a dash where there are none, or not told</source>
        <translation>Iteraciones del ajuste; un guion donde no las hay o no se dicen</translation>
    </message>
    <message>
        <source>Time [s]</source>
        <translation>Tiempo [s]</translation>
    </message>
    <message>
        <source>Time of initialisation and refinement from all views</source>
        <translation>Tiempo de inicio y ajuste con todas las vistas</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Tiempo</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Notas</translation>
    </message>
    <message>
        <source>Principal point; of methods marked * the distortion&apos;s centre</source>
        <translation>Punto principal; en métodos con * el centro de la distorsión</translation>
    </message>
    <message>
        <source>Focal length across the image</source>
        <translation>Distancia focal a lo ancho de la imagen</translation>
    </message>
    <message>
        <source>Focal length down the image</source>
        <translation>Distancia focal a lo alto de la imagen</translation>
    </message>
    <message>
        <source>Shift across the image over a length of fy down it</source>
        <translation>Desplazamiento a lo ancho en una longitud fy a lo alto</translation>
    </message>
    <message>
        <source>How far the distortion moves points that are measured {0:.0f} px from the centre,
where the outermost corner lies; negative towards it</source>
        <translation>Cuánto mueve la distorsión los puntos medidos a {0:.0f} px del centro,
donde está la esquina más alejada; negativo hacia él</translation>
    </message>
    <message>
        <source>Shift</source>
        <translation>Desvío</translation>
    </message>
    <message>
        <source>Coefficients</source>
        <translation>Coeficientes</translation>
    </message>
    <message>
        <source>{0} ± {1:.2g} px (1σ)</source>
        <translation>{0} ± {1:.2g} px (1σ)</translation>
    </message>
    <message>
        <source>It does not estimate this. {0}</source>
        <translation>No lo estima. {0}</translation>
    </message>
    <message>
        <source>One standard deviation of {0}</source>
        <translation>Una desviación estándar de {0}</translation>
    </message>
    <message>
        <source>σ of {0}</source>
        <translation>σ de {0}</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Método</translation>
    </message>
</context>
<context>
    <name>MethodsPanel</name>
    <message>
        <source>Methods</source>
        <translation>Métodos</translation>
    </message>
    <message>
        <source>All methods of calibration on the same corners.</source>
        <translation>Todos los métodos de calibración con las mismas esquinas.</translation>
    </message>
    <message>
        <source>C&amp;ompare methods</source>
        <translation>C&amp;omparar métodos</translation>
    </message>
    <message>
        <source>Calibrates with every method from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>Calibra con cada método con estas vistas, y otra vez sin algunas, para ver cómo predice lo que no ha visto. Tarda un rato.</translation>
    </message>
    <message>
        <source>Comparing methods</source>
        <translation>Comparando métodos</translation>
    </message>
    <message>
        <source>Calibrating with every method several times…</source>
        <translation>Calibrando con cada método varias veces…</translation>
    </message>
    <message>
        <source>&amp;Use this method</source>
        <translation>&amp;Usar este método</translation>
    </message>
    <message>
        <source>About the method</source>
        <translation>Sobre el método</translation>
    </message>
    <message>
        <source>Map</source>
        <translation>Mapa</translation>
    </message>
    <message>
        <source>About</source>
        <translation>Sobre</translation>
    </message>
    <message>
        <source>The views do not determine the camera: methods cannot be compared on them.</source>
        <translation>Las vistas no determinan la cámara: no se pueden comparar métodos con ellas.</translation>
    </message>
    <message>
        <source>This result is by the method “{0}”. What would others make of it?</source>
        <translation>Este resultado es del método «{0}». ¿Qué harían otros con él?</translation>
    </message>
    <message>
        <source>Each RMS and σ is of {0:,} corners in {1} views.</source>
        <translation>Cada RMS y σ es de {0:,} esquinas en {1} vistas.</translation>
    </message>
    <message>
        <source>Differences are from the calibration that was shown when they were found.</source>
        <translation>Las diferencias son con la calibración que se mostraba cuando se hallaron.</translation>
    </message>
    <message>
        <source>Set the selected method in the Set-up and calibrate.</source>
        <translation>Poner el método elegido en los Ajustes y calibrar.</translation>
    </message>
    <message>
        <source>It gives no camera from these views: {0}</source>
        <translation>No da una cámara con estas vistas: {0}</translation>
    </message>
    <message>
        <source>It knows no lengths, and so gives no camera: only the distortion.</source>
        <translation>No conoce longitudes y por eso no da una cámara: solo la distorsión.</translation>
    </message>
    <message>
        <source>Its coefficients: {0}.</source>
        <translation>Sus coeficientes: {0}.</translation>
    </message>
    <message>
        <source>Source: {0}</source>
        <translation>Fuente: {0}</translation>
    </message>
</context>
<context>
    <name>ModeBar</name>
    <message>
        <source>What the desk shows</source>
        <translation>Lo que muestra la mesa</translation>
    </message>
</context>
<context>
    <name>Offers</name>
    <message>
        <source>&amp;All {0} images</source>
        <translation>Las &amp;{0} imágenes</translation>
    </message>
    <message>
        <source>A report tells how a camera was calibrated, and this one is known from a file. Calibrate it from these photographs?</source>
        <translation>Un informe dice cómo se calibró una cámara, y esta se conoce por un archivo. ¿Calibrarla con estas fotografías?</translation>
    </message>
    <message>
        <source>C&amp;alibrate it</source>
        <translation>C&amp;alibrarla</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation type="unfinished">Calibrar de nuevo</translation>
    </message>
    <message>
        <source>Open {0}</source>
        <translation>Abrir {0}</translation>
    </message>
    <message>
        <source>The program ended without saving {0}. Its state of {1} has been kept. The project was saved {2}.</source>
        <translation>El programa terminó sin guardar {0}. Se conserva su estado de {1}. El proyecto se guardó {2}.</translation>
    </message>
    <message>
        <source>The program ended without saving a project of {0} photographs in {1}, which had no name yet. Its state of {2} has been kept.</source>
        <translation>El programa terminó sin guardar un proyecto de {0} fotos en {1}, aún sin nombre. Se conserva su estado de {2}.</translation>
    </message>
    <message>
        <source>The program ended without saving a project that had no name yet. Its state of {0} has been kept.</source>
        <translation>El programa terminó sin guardar un proyecto aún sin nombre. Se conserva su estado de {0}.</translation>
    </message>
    <message>
        <source>&amp;Recover</source>
        <translation>&amp;Recuperar</translation>
    </message>
    <message>
        <source>Go on &amp;without</source>
        <translation>Seguir &amp;sin él</translation>
    </message>
    <message>
        <source>The unsaved state is kept for a while, as {0}.</source>
        <translation>El estado sin guardar queda un tiempo, como {0}.</translation>
    </message>
    <message>
        <source>&amp;Bring it back</source>
        <translation>&amp;Traerlo de nuevo</translation>
    </message>
    <message>
        <source>{0} of {1} images changed since their corners were found, among them {2}.</source>
        <translation>{0} de {1} imágenes cambiaron desde que se hallaron sus esquinas, entre ellas {2}.</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>&amp;Buscar de nuevo</translation>
    </message>
    <message>
        <source>{0} of {1} images are not where they were, among them {2}.</source>
        <translation>{0} de {1} imágenes no están donde estaban, entre ellas {2}.</translation>
    </message>
    <message>
        <source>{0} of {1} images are at addresses, among them {2}. Download them, and locate the copies.</source>
        <translation>{0} de {1} imágenes están en direcciones, entre ellas {2}. Descárguelas y localice las copias.</translation>
    </message>
    <message>
        <source>&amp;Locate…</source>
        <translation>&amp;Localizar…</translation>
    </message>
    <message>
        <source>Looking for another kind of board</source>
        <translation>Buscando otra clase de tablero</translation>
    </message>
    <message>
        <source>The photographs are mirrored, so that the marks on the board cannot be read. Turn mirroring off in the camera or in its program, and take them again.</source>
        <translation>Las fotos están reflejadas, y no se pueden leer las marcas del tablero. Desactive el reflejo en la cámara o en su programa y hágalas de nuevo.</translation>
    </message>
    <message>
        <source>A board of {0} × {1} inner corners is in no image; the images show {2} × {3}.</source>
        <translation>Un tablero de {0} × {1} esquinas interiores no está en ninguna imagen; muestran {2} × {3}.</translation>
    </message>
    <message>
        <source>&amp;Search for {0} × {1}</source>
        <translation>&amp;Buscar {0} × {1}</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Número de esquinas</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>Patrón</translation>
    </message>
</context>
<context>
    <name>OnDemandPanel</name>
    <message>
        <source>What was found</source>
        <translation>Lo que se encontró</translation>
    </message>
</context>
<context>
    <name>OwnPages</name>
    <message>
        <source>Several cameras</source>
        <translation type="unfinished">Varias cámaras</translation>
    </message>
    <message>
        <source>Are these the photographs of several cameras that stand fast to each other, a folder or a video for each? No: all are of one camera.</source>
        <translation>¿Son fotografías de varias cámaras fijas entre sí, una carpeta o un vídeo por cámara? No: todas son de una sola cámara.</translation>
    </message>
</context>
<context>
    <name>PairingMatrix</name>
    <message>
        <source>Photographs by cameras and instants</source>
        <translation>Fotos por cámaras e instantes</translation>
    </message>
    <message>
        <source>A column for each camera, a row for each instant. Click a camera&apos;s name to choose all its photographs.</source>
        <translation>Una columna por cámara, una fila por instante. Pulse el nombre de una cámara para elegir todas sus fotos.</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>omitido</translation>
    </message>
    <message>
        <source>{0}: contradicts the others</source>
        <translation>{0}: contradice a las demás</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>{0}: {1} corners, {2} px rms; alone {3} px</source>
        <translation>{0}: {1} esquinas, {2} px RMS; sola {3} px</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>sin tablero</translation>
    </message>
</context>
<context>
    <name>PairingPane</name>
    <message>
        <source>Earli&amp;er</source>
        <translation type="unfinished">&amp;Antes</translation>
    </message>
    <message>
        <source>La&amp;ter</source>
        <translation type="unfinished">&amp;Después</translation>
    </message>
    <message>
        <source>Lea&amp;ve out</source>
        <translation type="unfinished">&amp;Omitir</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation type="unfinished">&amp;Deshacer</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant before</source>
        <translation type="unfinished">Mover las fotos elegidas de una cámara al instante anterior</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant after</source>
        <translation type="unfinished">Mover las fotos elegidas de una cámara al instante siguiente</translation>
    </message>
</context>
<context>
    <name>Palette</name>
    <message>
        <source>Find an action</source>
        <translation>Buscar una acción</translation>
    </message>
    <message>
        <source>Type a part of what you want to do</source>
        <translation>Escriba una parte de lo que quiere hacer</translation>
    </message>
    <message>
        <source>Part of an action&apos;s name</source>
        <translation>Parte del nombre de una acción</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Borrar</translation>
    </message>
    <message>
        <source>Actions</source>
        <translation>Acciones</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>Acción</translation>
    </message>
    <message>
        <source>Menu</source>
        <translation>Menú</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Teclas</translation>
    </message>
    <message>
        <source>No action of the menus is called so.</source>
        <translation>Ninguna acción de los menús se llama así.</translation>
    </message>
</context>
<context>
    <name>Panel</name>
    <message>
        <source>Nothing is calibrated yet. What Calibrate finds is shown here.</source>
        <translation>Aún no hay nada calibrado. Lo que halla Calibrar se muestra aquí.</translation>
    </message>
</context>
<context>
    <name>ParameterTable</name>
    <message>
        <source>Parameter</source>
        <translation>Parámetro</translation>
    </message>
    <message>
        <source>Real</source>
        <translation>Real</translation>
    </message>
    <message>
        <source>Synthetic</source>
        <translation>Sintético</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Diferencia</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>en σ</translation>
    </message>
    <message>
        <source>The difference over the synthetic result&apos;s standard deviation.</source>
        <translation>La diferencia dividida por la desviación estándar del resultado sintético.</translation>
    </message>
</context>
<context>
    <name>PatternChoice</name>
    <message>
        <source>Pattern</source>
        <translation>Patrón</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>Lo que está impreso en el tablero.</translation>
    </message>
    <message>
        <source>The set of markers on the board, by OpenCV&apos;s name.</source>
        <translation>El juego de marcadores del tablero, con el nombre de OpenCV.</translation>
    </message>
    <message>
        <source>Boards with an even number of rows of squares changed with OpenCV 4.6.</source>
        <translation>Los tableros con un número par de filas de cuadros cambiaron con OpenCV 4.6.</translation>
    </message>
    <message>
        <source>first square dark</source>
        <translation>primer cuadro oscuro</translation>
    </message>
    <message>
        <source>as before OpenCV 4.6</source>
        <translation>como antes de OpenCV 4.6</translation>
    </message>
    <message>
        <source>A table (CSV) of the circles&apos; x and y in mm, or the same as JSON.</source>
        <translation>Una tabla (CSV) con x e y de los círculos en mm, o lo mismo como JSON.</translation>
    </message>
    <message>
        <source>The family of the AprilTags on the board.</source>
        <translation>La familia de los AprilTags del tablero.</translation>
    </message>
    <message>
        <source>The gap between tags over the side of a tag, at most 1: Kalibr&apos;s tagSpacing.</source>
        <translation>El hueco entre etiquetas dividido por el lado de una, como mucho 1: tagSpacing de Kalibr.</translation>
    </message>
    <message>
        <source>The width of a tag&apos;s black border; 2 cells on Kalibr&apos;s.</source>
        <translation>El ancho del borde negro de una etiqueta; 2 celdas en Kalibr.</translation>
    </message>
    <message>
        <source>2 cells</source>
        <translation>2 celdas</translation>
    </message>
    <message>
        <source>1 cell</source>
        <translation>1 celda</translation>
    </message>
    <message>
        <source>The row of tags that holds the lowest numbers.</source>
        <translation>La fila de etiquetas con los números más bajos.</translation>
    </message>
    <message>
        <source>from the bottom, as Kalibr</source>
        <translation>desde abajo, como Kalibr</translation>
    </message>
    <message>
        <source>from the top</source>
        <translation>desde arriba</translation>
    </message>
    <message>
        <source>Small dark squares between the corners of the tags, as on Kalibr&apos;s.</source>
        <translation>Cuadritos oscuros entre las esquinas de las etiquetas, como en Kalibr.</translation>
    </message>
    <message>
        <source>between the tags</source>
        <translation>entre las etiquetas</translation>
    </message>
    <message>
        <source>none</source>
        <translation>ninguno</translation>
    </message>
    <message>
        <source>The number of squares from one tag to the next in its row.</source>
        <translation>El número de cuadros de una etiqueta a la siguiente en su fila.</translation>
    </message>
    <message>
        <source>Row of the first corner</source>
        <translation>Fila de la primera esquina</translation>
    </message>
    <message>
        <source>Column of the first corner</source>
        <translation>Columna de la primera esquina</translation>
    </message>
    <message>
        <source>Row and column of the board&apos;s first corner on the whole PuzzleBoard pattern.</source>
        <translation>Fila y columna de la primera esquina del tablero en el patrón PuzzleBoard completo.</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>Esquinas interiores</translation>
    </message>
    <message>
        <source>Small squares</source>
        <translation>Cuadritos</translation>
    </message>
    <message>
        <source>List</source>
        <translation>Lista</translation>
    </message>
    <message>
        <source>Dictionary</source>
        <translation>Diccionario</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>Marcador</translation>
    </message>
    <message>
        <source>Layout</source>
        <translation>Disposición</translation>
    </message>
    <message>
        <source>Diameter</source>
        <translation>Diámetro</translation>
    </message>
    <message>
        <source>Tag family</source>
        <translation>Familia</translation>
    </message>
    <message>
        <source>Gap / side</source>
        <translation>Hueco / lado</translation>
    </message>
    <message>
        <source>Tag border</source>
        <translation>Borde</translation>
    </message>
    <message>
        <source>Tag step</source>
        <translation>Paso</translation>
    </message>
    <message>
        <source>Numbered</source>
        <translation>Numerado</translation>
    </message>
    <message>
        <source>First marker</source>
        <translation>Primer marcador</translation>
    </message>
    <message>
        <source>First tag</source>
        <translation>Primera etiqueta</translation>
    </message>
    <message>
        <source>First corner</source>
        <translation>Primera esquina</translation>
    </message>
    <message>
        <source>The lowest number of a marker or tag on the board: 0 on most.</source>
        <translation>El número más bajo de un marcador o etiqueta del tablero: 0 en la mayoría.</translation>
    </message>
    <message>
        <source>Choose a file…</source>
        <translation>Elegir un archivo…</translation>
    </message>
    <message>
        <source>{0} circles…</source>
        <translation>{0} círculos…</translation>
    </message>
    <message>
        <source>List of circles</source>
        <translation>Lista de círculos</translation>
    </message>
    <message>
        <source>Lists of circles (*.csv *.json)</source>
        <translation>Listas de círculos (*.csv *.json)</translation>
    </message>
</context>
<context>
    <name>PatternTexts</name>
    <message>
        <source>Checkerboard</source>
        <translation>Ajedrezado</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard.</source>
        <translation>Parecen fotos de un tablero ajedrezado.</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard</source>
        <translation>&amp;Buscar un tablero ajedrezado</translation>
    </message>
    <message>
        <source>ChArUco board</source>
        <translation>Tablero ChArUco</translation>
    </message>
    <message>
        <source>These look like photographs of a ChArUco board.</source>
        <translation>Parecen fotos de un tablero ChArUco.</translation>
    </message>
    <message>
        <source>&amp;Search for a ChArUco board</source>
        <translation>&amp;Buscar un tablero ChArUco</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>Círculos</translation>
    </message>
    <message>
        <source>These look like photographs of a grid of circles.</source>
        <translation>Parecen fotos de una rejilla de círculos.</translation>
    </message>
    <message>
        <source>&amp;Search for circles</source>
        <translation>&amp;Buscar círculos</translation>
    </message>
    <message>
        <source>Asymmetric circles</source>
        <translation>Círculos asimétricos</translation>
    </message>
    <message>
        <source>These look like photographs of an asymmetric grid of circles.</source>
        <translation>Parecen fotos de una rejilla asimétrica de círculos.</translation>
    </message>
    <message>
        <source>&amp;Search for asymmetric circles</source>
        <translation>&amp;Buscar círculos asimétricos</translation>
    </message>
    <message>
        <source>Circles of a list</source>
        <translation>Círculos de una lista</translation>
    </message>
    <message>
        <source>These look like photographs of listed circles.</source>
        <translation>Parecen fotos de círculos de una lista.</translation>
    </message>
    <message>
        <source>&amp;Search for listed circles</source>
        <translation>&amp;Buscar círculos de la lista</translation>
    </message>
    <message>
        <source>AprilGrid</source>
        <translation>AprilGrid</translation>
    </message>
    <message>
        <source>These look like photographs of an AprilGrid.</source>
        <translation>Parecen fotos de un AprilGrid.</translation>
    </message>
    <message>
        <source>&amp;Search for an AprilGrid</source>
        <translation>&amp;Buscar un AprilGrid</translation>
    </message>
    <message>
        <source>Checkerboard with tags</source>
        <translation>Ajedrezado con etiquetas</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard with AprilTags.</source>
        <translation>Parecen fotos de un tablero ajedrezado con AprilTags.</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard with tags</source>
        <translation>&amp;Buscar un ajedrezado con etiquetas</translation>
    </message>
    <message>
        <source>PuzzleBoard</source>
        <translation>PuzzleBoard</translation>
    </message>
    <message>
        <source>These look like photographs of a PuzzleBoard.</source>
        <translation>Parecen fotos de un PuzzleBoard.</translation>
    </message>
    <message>
        <source>&amp;Search for a PuzzleBoard</source>
        <translation>&amp;Buscar un PuzzleBoard</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>Esquinas</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>Esquinas interiores</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation type="unfinished">Distancia</translation>
    </message>
    <message>
        <source>Tag</source>
        <translation type="unfinished">Etiqueta</translation>
    </message>
    <message>
        <source>Square</source>
        <translation type="unfinished">Cuadro</translation>
    </message>
</context>
<context>
    <name>PlaneChoice</name>
    <message>
        <source>in the image</source>
        <translation>en la imagen</translation>
    </message>
    <message>
        <source>on the reference plane</source>
        <translation>en el plano de referencia</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>px de referencia</translation>
    </message>
    <message>
        <source>In the image a residual is the measured less the predicted corner.
The paper&apos;s reference plane has 30 px to a square; residuals of far and tilted
boards look larger there (figures 10 to 12).</source>
        <translation>En la imagen un residuo es la esquina medida menos la predicha.
El plano de referencia del artículo tiene 30 px por cuadro; los residuos de tableros
lejanos e inclinados parecen mayores ahí (figuras 10 a 12).</translation>
    </message>
    <message>
        <source>Where residuals are shown</source>
        <translation>Dónde se muestran los residuos</translation>
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
        <translation>Mostrar todo</translation>
    </message>
    <message>
        <source>Copy as image</source>
        <translation>Copiar como imagen</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>Guardar gráfico…</translation>
    </message>
</context>
<context>
    <name>PoseErrors</name>
    <message>
        <source>relative error of an external parameter</source>
        <translation>error relativo de un parámetro externo</translation>
    </message>
    <message>
        <source>count</source>
        <translation>número</translation>
    </message>
    <message>
        <source>|z real − z synthetic| / |z real| of eq. 51 (figure 14).</source>
        <translation>|z real − z sintético| / |z real| de la ec. 51 (figura 14).</translation>
    </message>
    <message>
        <source>median {0:.3g} %, largest {1:.3g} %</source>
        <translation>mediana {0:.3g} %, mayor {1:.3g} %</translation>
    </message>
</context>
<context>
    <name>PosesPanel</name>
    <message>
        <source>Poses</source>
        <translation>Poses</translation>
    </message>
    <message>
        <source>Where the board was held before the camera, in space: the extrinsics.</source>
        <translation>Dónde se sostuvo el tablero ante la cámara, en el espacio: los extrínsecos.</translation>
    </message>
    <message>
        <source>Camera at rest</source>
        <translation>Cámara en reposo</translation>
    </message>
    <message>
        <source>Board at rest</source>
        <translation>Tablero en reposo</translation>
    </message>
    <message>
        <source>What stands still in the picture: the camera, with the boards around it, or the board, with the cameras around it.</source>
        <translation>Qué está quieto en la imagen: la cámara, con los tableros alrededor, o el tablero, con las cámaras alrededor.</translation>
    </message>
    <message>
        <source>What stands still</source>
        <translation>Qué está quieto</translation>
    </message>
    <message>
        <source>&amp;Reset view</source>
        <translation>&amp;Restablecer vista</translation>
    </message>
    <message>
        <source>Show everything, from where it was seen first</source>
        <translation>Mostrar todo, desde donde se vio primero</translation>
    </message>
    <message>
        <source>Drag to turn, wheel to zoom, click a board or camera to see its image.</source>
        <translation>Arrastre para girar, rueda para ampliar; pulse un tablero o una cámara para ver su imagen.</translation>
    </message>
    <message>
        <source>Camera and boards in space</source>
        <translation>Cámara y tableros en el espacio</translation>
    </message>
    <message>
        <source>{0}: {1:.0f} mm away{2}, tilted by {3:.0f}°</source>
        <translation>{0}: a {1:.0f} mm{2}, inclinado {3:.0f}°</translation>
    </message>
    <message>
        <source>{0} views, {1:.0f} to {2:.0f} mm away{3}, tilted by {4:.0f}° to {5:.0f}°</source>
        <translation>{0} vistas, de {1:.0f} a {2:.0f} mm{3}, inclinadas de {4:.0f}° a {5:.0f}°</translation>
    </message>
</context>
<context>
    <name>Preparation</name>
    <message>
        <source>Compiling for speed, once</source>
        <translation type="unfinished">Compilando para ir rápido, una sola vez</translation>
    </message>
</context>
<context>
    <name>PrintDialog</name>
    <message>
        <source>Board to print</source>
        <translation>Tablero para imprimir</translation>
    </message>
    <message>
        <source>usual</source>
        <translation>usual</translation>
    </message>
    <message>
        <source>Rows</source>
        <translation>Filas</translation>
    </message>
    <message>
        <source>Columns</source>
        <translation>Columnas</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>&amp;Paper</source>
        <translation>&amp;Papel</translation>
    </message>
    <message>
        <source>An odd and an even number of squares
lets every view find the same origin.</source>
        <translation>Un número impar y uno par de cuadros
hacen que cada vista halle el mismo origen.</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Guardar…</translation>
    </message>
    <message>
        <source>Show on this scr&amp;een</source>
        <translation>Mostrar en esta &amp;pantalla</translation>
    </message>
    <message>
        <source>As large as the screen holds it: a screen is flat, and needs no printer</source>
        <translation>Tan grande como quepa: una pantalla es plana y no necesita impresora</translation>
    </message>
    <message>
        <source>Tags</source>
        <translation>Etiquetas</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>Lado de una etiqueta</translation>
    </message>
    <message>
        <source>Squares</source>
        <translation>Cuadros</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Lado de un cuadro</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>Círculos</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>Distancia</translation>
    </message>
    <message>
        <source>Fits. Print it without scaling.</source>
        <translation>Cabe. Imprímalo sin escalar.</translation>
    </message>
    <message>
        <source>Save board</source>
        <translation>Guardar tablero</translation>
    </message>
    <message>
        <source>PDF (*.pdf);;SVG drawing (*.svg);;PNG image (*.png)</source>
        <translation>PDF (*.pdf);;Dibujo SVG (*.svg);;Imagen PNG (*.png)</translation>
    </message>
</context>
<context>
    <name>Progress</name>
    <message>
        <source>Stop this; what is finished stays (Shift+F9)</source>
        <translation>Detener esto; lo acabado queda (Mayús+F9)</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Detener</translation>
    </message>
    <message>
        <source>Stopping…</source>
        <translation>Deteniendo…</translation>
    </message>
    <message>
        <source>: {0} of {1}</source>
        <translation>: {0} de {1}</translation>
    </message>
    <message>
        <source>, {0} left</source>
        <translation>, faltan {0}</translation>
    </message>
</context>
<context>
    <name>ProgressFigure</name>
    <message>
        <source>How far the capture has come</source>
        <translation>Cuánto ha avanzado la toma</translation>
    </message>
    <message>
        <source>The ring: the uncertainty of the worst pixel, one standard deviation, and the one that is asked for.
The rectangle: the corners in all pictures, over the sensor.
The circle: how the boards were tilted; the middle is facing the camera, the rim 60 degrees.</source>
        <translation>El anillo: la incertidumbre del peor píxel, una desviación estándar, y la pedida.
El rectángulo: las esquinas de todas las fotos, sobre el sensor.
El círculo: cómo se inclinaron los tableros; el centro es de frente, el borde 60 grados.</translation>
    </message>
    <message>
        <source>nothing taken</source>
        <translation>nada tomado</translation>
    </message>
    <message>
        <source>{0} taken, not determined yet</source>
        <translation>{0} tomadas, aún sin determinar</translation>
    </message>
    <message>
        <source>{0} taken, worst pixel ±{1} px of {2}</source>
        <translation>{0} tomadas, peor píxel ±{1} px de {2}</translation>
    </message>
    <message>
        <source>±{0} px</source>
        <translation>±{0} px</translation>
    </message>
    <message>
        <source>of {0} px</source>
        <translation>de {0} px</translation>
    </message>
    <message>
        <source>corners on the sensor</source>
        <translation>esquinas en el sensor</translation>
    </message>
    <message>
        <source>tilts</source>
        <translation>inclinaciones</translation>
    </message>
</context>
<context>
    <name>RemedyRunner</name>
    <message>
        <source>Calibration</source>
        <translation>Calibración</translation>
    </message>
</context>
<context>
    <name>ReportDialog</name>
    <message>
        <source>Report</source>
        <translation>Informe</translation>
    </message>
    <message>
        <source>All that is known</source>
        <translation>Todo lo que se sabe</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Certificado</translation>
    </message>
    <message>
        <source>After ISO/IEC 17025, 7.8.2 and 7.8.4</source>
        <translation>Según ISO/IEC 17025, 7.8.2 y 7.8.4</translation>
    </message>
    <message>
        <source>Letter</source>
        <translation>Carta</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation>sin indicar</translation>
    </message>
    <message>
        <source>&amp;Layout</source>
        <translation>&amp;Diseño</translation>
    </message>
    <message>
        <source>Pa&amp;per</source>
        <translation>&amp;Papel</translation>
    </message>
    <message>
        <source>What stands here is kept with the project. For PDF: pip install &apos;calibgui[report]&apos;.</source>
        <translation>Lo que figura aquí se guarda con el proyecto. Para PDF: pip install &apos;calibgui[report]&apos;.</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>&amp;Guardar…</translation>
    </message>
    <message>
        <source>Number of the report</source>
        <translation>Número del informe</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Operador</translation>
    </message>
    <message>
        <source>Laboratory</source>
        <translation>Laboratorio</translation>
    </message>
    <message>
        <source>Place of calibration</source>
        <translation>Lugar de calibración</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>Temperatura</translation>
    </message>
    <message>
        <source>Customer</source>
        <translation>Cliente</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>Serial number of the camera</source>
        <translation>Número de serie de la cámara</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Lente</translation>
    </message>
    <message>
        <source>Serial number of the lens</source>
        <translation>Número de serie de la lente</translation>
    </message>
    <message>
        <source>Aperture, focus, zoom</source>
        <translation>Apertura, enfoque, zoom</translation>
    </message>
    <message>
        <source>Condition of the item</source>
        <translation>Estado del objeto</translation>
    </message>
    <message>
        <source>Date of receipt</source>
        <translation>Fecha de recepción</translation>
    </message>
    <message>
        <source>Date of calibration</source>
        <translation>Fecha de calibración</translation>
    </message>
    <message>
        <source>Identification of the board</source>
        <translation>Identificación del tablero</translation>
    </message>
    <message>
        <source>Certificate of the board</source>
        <translation>Certificado del tablero</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Notas</translation>
    </message>
    <message>
        <source>Authorised by</source>
        <translation>Autorizado por</translation>
    </message>
    <message>
        <source>Details of the report</source>
        <translation>Datos del informe</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>Escribiendo {0}</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Guardado como {0}</translation>
    </message>
</context>
<context>
    <name>ResidualsPanel</name>
    <message>
        <source>Residuals</source>
        <translation>Residuos</translation>
    </message>
    <message>
        <source>Measured minus predicted corners.</source>
        <translation>Esquinas medidas menos predichas.</translation>
    </message>
    <message>
        <source>Click a point to see its corner in the image.</source>
        <translation>Pulse un punto para ver su esquina en la imagen.</translation>
    </message>
    <message>
        <source>{0}: mean {1:.3f}, SD {2:.3f} {3}</source>
        <translation>{0}: media {1:.3f}, DE {2:.3f} {3}</translation>
    </message>
    <message>
        <source>σ: {0} {1:.3f}, {2} {3:.3f} px</source>
        <translation>σ: {0} {1:.3f}, {2} {3:.3f} px</translation>
    </message>
    <message>
        <source>Do the residuals look like noise? Working…</source>
        <translation>¿Parecen ruido los residuos? Calculando…</translation>
    </message>
    <message>
        <source>Examining the residuals</source>
        <translation>Examinando los residuos</translation>
    </message>
    <message>
        <source>Whether the residuals look like noise was not examined.</source>
        <translation>No se examinó si los residuos parecen ruido.</translation>
    </message>
    <message>
        <source>The residuals look like noise: nothing speaks against the ± of the result.</source>
        <translation>Los residuos parecen ruido: nada habla contra los ± del resultado.</translation>
    </message>
    <message>
        <source> Beyond {0:g} σ: {1} in {2}, each within its own uncertainty.</source>
        <translation> Más allá de {0:g} σ: {1} en {2}, cada una dentro de su propia incertidumbre.</translation>
    </message>
    <message>
        <source>The residuals are not just noise. Why is being tried.</source>
        <translation>Los residuos no son solo ruido. Se investiga por qué.</translation>
    </message>
    <message>
        <source>The residuals are not just noise, but no cause of it stands out that matters.</source>
        <translation>Los residuos no son solo ruido, pero no destaca ninguna causa que importe.</translation>
    </message>
    <message>
        <source>The residuals are not just noise. {0} {1}</source>
        <translation>Los residuos no son solo ruido. {0} {1}</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Result</source>
        <translation>Resultado</translation>
    </message>
    <message>
        <source>The camera&apos;s parameters with their standard deviations, and what they are worth.</source>
        <translation>Los parámetros de la cámara con sus desviaciones estándar, y lo que valen.</translation>
    </message>
    <message>
        <source>Summary</source>
        <translation>Resumen</translation>
    </message>
    <message>
        <source>Estimates near ±1 can stand in for each other: only a combination is known.</source>
        <translation>Las estimaciones cerca de ±1 pueden sustituirse: solo se conoce una combinación.</translation>
    </message>
    <message>
        <source>The paper&apos;s units</source>
        <translation>Unidades del artículo</translation>
    </message>
    <message>
        <source>Correlations</source>
        <translation>Correlaciones</translation>
    </message>
    <message>
        <source>What this result is worth is being found out.</source>
        <translation>Se averigua lo que vale este resultado.</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parámetro</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Valor</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Unidad</translation>
    </message>
    <message>
        <source>Remark</source>
        <translation>Nota</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>DE de la tabla 2</translation>
    </message>
    <message>
        <source>The paper&apos;s sqrt(diag((2 JᵀJ)⁻¹)), which leaves the residuals out.
1σ is what the residuals support.</source>
        <translation>sqrt(diag((2 JᵀJ)⁻¹)) del artículo, sin el tamaño de los residuos.
1σ es lo que los residuos respaldan.</translation>
    </message>
    <message>
        <source>held</source>
        <translation>fijo</translation>
    </message>
    <message>
        <source>not determined</source>
        <translation>indeterminado</translation>
    </message>
    <message>
        <source>assumed</source>
        <translation>supuesto</translation>
    </message>
    <message>
        <source>may be 0</source>
        <translation>quizá 0</translation>
    </message>
</context>
<context>
    <name>RigAnswer</name>
    <message>
        <source>Where the cameras stand</source>
        <translation>Dónde están las cámaras</translation>
    </message>
    <message>
        <source>Where the boards stand</source>
        <translation>Dónde están los tableros</translation>
    </message>
    <message>
        <source>Cameras</source>
        <translation>Cámaras</translation>
    </message>
    <message>
        <source>Points ahead</source>
        <translation>Puntos delante</translation>
    </message>
    <message>
        <source>The cameras agree</source>
        <translation>Las cámaras concuerdan</translation>
    </message>
    <message>
        <source>Photographs contradict</source>
        <translation>Hay fotos que se contradicen</translation>
    </message>
    <message>
        <source>The instants disagree</source>
        <translation>Los instantes no concuerdan</translation>
    </message>
    <message>
        <source>All lengths hold {0}.</source>
        <translation>Todas las longitudes valen {0}.</translation>
    </message>
    <message>
        <source>camera</source>
        <translation>cámara</translation>
    </message>
    <message>
        <source>Root mean square residual of this camera in the rig, px</source>
        <translation>Residuo RMS de esta cámara en el conjunto, px</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>Número de esquinas</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>distancia</translation>
    </message>
    <message>
        <source>± along</source>
        <translation>± a lo largo</translation>
    </message>
    <message>
        <source>Standard deviation along the line of sight, with this rig&apos;s noise, mm</source>
        <translation>Desviación estándar a lo largo de la línea de visión, con el ruido de este conjunto, mm</translation>
    </message>
    <message>
        <source>± across</source>
        <translation>± a través</translation>
    </message>
    <message>
        <source>calib.</source>
        <translation>calib.</translation>
    </message>
    <message>
        <source>Part of the variance that the calibration is to blame for, %</source>
        <translation>Parte de la varianza debida a la calibración, %</translation>
    </message>
    <message>
        <source>from {0}</source>
        <translation>desde {0}</translation>
    </message>
    <message>
        <source>Distance of the two cameras&apos; centres, mm</source>
        <translation>Distancia entre los centros de las dos cámaras, mm</translation>
    </message>
    <message>
        <source>turn</source>
        <translation>giro</translation>
    </message>
    <message>
        <source>Angle between the two cameras, degrees</source>
        <translation>Ángulo entre las dos cámaras, grados</translation>
    </message>
    <message>
        <source>{0} from {1}</source>
        <translation>{0} desde {1}</translation>
    </message>
    <message>
        <source>board</source>
        <translation>tablero</translation>
    </message>
    <message>
        <source>from board {0}</source>
        <translation>desde tablero {0}</translation>
    </message>
    <message>
        <source>Distance of the boards&apos; origins, mm</source>
        <translation>Distancia entre los orígenes de los tableros, mm</translation>
    </message>
    <message>
        <source>Angle between the boards, degrees</source>
        <translation>Ángulo entre los tableros, grados</translation>
    </message>
</context>
<context>
    <name>RigForm</name>
    <message>
        <source>Shape of the boards</source>
        <translation>Forma de los tableros</translation>
    </message>
    <message>
        <source> ms</source>
        <translation> ms</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation type="unfinished">automático</translation>
    </message>
    <message>
        <source>Photographs that were taken at most so far apart are of one instant: by their names (seconds or nanoseconds since 1970, as of ROS) or by EXIF</source>
        <translation>Las fotografías tomadas con esta separación como máximo son de un mismo instante: según sus nombres (segundos o nanosegundos desde 1970, como en ROS) o según EXIF</translation>
    </message>
    <message>
        <source>Pair photographs taken within</source>
        <translation>Emparejar fotografías tomadas en</translation>
    </message>
    <message>
        <source>one of </source>
        <translation>uno de cada </translation>
    </message>
    <message>
        <source>all</source>
        <translation type="unfinished">todas</translation>
    </message>
    <message>
        <source>Frames of videos that are taken</source>
        <translation>Fotogramas que se toman de los vídeos</translation>
    </message>
    <message>
        <source>Leave out what no camera e&amp;xplains</source>
        <translation type="unfinished">Omitir lo que ninguna cámara e&amp;xplica</translation>
    </message>
    <message>
        <source>Corners and views that no camera explains take no part</source>
        <translation type="unfinished">Las esquinas y vistas que ninguna cámara explica no participan</translation>
    </message>
    <message>
        <source>Estimate how late each camera &amp;is</source>
        <translation>Estimar el &amp;retraso de cada cámara</translation>
    </message>
    <message>
        <source>From a board that moves, in videos or in photographs that are paired by time: the clock of each camera may be late</source>
        <translation>A partir de un tablero en movimiento, en vídeos o en fotografías emparejadas por tiempo: el reloj de cada cámara puede ir retrasado</translation>
    </message>
    <message>
        <source>The boards are</source>
        <translation>Los tableros son</translation>
    </message>
    <message>
        <source>Frames of videos</source>
        <translation>Fotogramas de vídeos</translation>
    </message>
</context>
<context>
    <name>RigPage</name>
    <message>
        <source>Pairing photographs</source>
        <translation>Emparejando fotos</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>Abriendo {0}</translation>
    </message>
    <message>
        <source>&amp;Folders…</source>
        <translation>Car&amp;petas…</translation>
    </message>
    <message>
        <source>O&amp;pen rig…</source>
        <translation>A&amp;brir conjunto…</translation>
    </message>
    <message>
        <source>&amp;Calibrate rig</source>
        <translation>&amp;Calibrar conjunto</translation>
    </message>
    <message>
        <source>&amp;Stop</source>
        <translation>&amp;Detener</translation>
    </message>
    <message>
        <source>C&amp;lose</source>
        <translation>C&amp;errar</translation>
    </message>
    <message>
        <source>Set-&amp;up</source>
        <translation>Config&amp;urar</translation>
    </message>
    <message>
        <source>What is stated of boards and photographs, to change it</source>
        <translation>Lo indicado sobre tableros y fotos, para cambiarlo</translation>
    </message>
    <message>
        <source>E&amp;xport</source>
        <translation>E&amp;xportar</translation>
    </message>
    <message>
        <source>Rig, with everything (JSON)…</source>
        <translation>Conjunto, con todo (JSON)…</translation>
    </message>
    <message>
        <source>Photographs</source>
        <translation>Fotos</translation>
    </message>
    <message>
        <source>Rectified</source>
        <translation>Rectificado</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>3-D</translation>
    </message>
    <message>
        <source>Several cameras</source>
        <translation>Varias cámaras</translation>
    </message>
    <message>
        <source>Cameras that stand fast to each other and photograph one board together: choose the folder that holds a folder for each camera (or all photographs, named as left01 and right01), or drop the folders here, or a video of each camera.</source>
        <translation>Cámaras fijas entre sí que fotografían juntas un tablero: elija la carpeta que contiene una carpeta por cámara (o todas las fotografías, con nombres como left01 y right01), o suelte aquí las carpetas, o un vídeo de cada cámara.</translation>
    </message>
    <message>
        <source>No photographs yet.</source>
        <translation>Aún no hay fotos.</translation>
    </message>
    <message>
        <source>Calibrate the rig first.</source>
        <translation>Calibre antes el conjunto.</translation>
    </message>
    <message>
        <source>No two cameras have a photograph of one instant.</source>
        <translation>Ningún par de cámaras tiene una foto del mismo instante.</translation>
    </message>
    <message>
        <source>{0} and {1} have no photographs of this instant together.</source>
        <translation>{0} y {1} no tienen fotos juntas de este instante.</translation>
    </message>
    <message>
        <source>Searching</source>
        <translation>Buscando</translation>
    </message>
    <message>
        <source>Calibrating {0}</source>
        <translation>Calibrando {0}</translation>
    </message>
    <message>
        <source>Lengths hold {0}.</source>
        <translation>Las longitudes valen {0}.</translation>
    </message>
    <message>
        <source>Folder with a folder for each camera, or the photographs of all</source>
        <translation>Carpeta con una carpeta por cámara, o con las fotos de todas</translation>
    </message>
    <message>
        <source>Open rig</source>
        <translation>Abrir conjunto</translation>
    </message>
    <message>
        <source>Rigs (*.json)</source>
        <translation>Conjuntos (*.json)</translation>
    </message>
    <message>
        <source>Save rig</source>
        <translation>Guardar conjunto</translation>
    </message>
    <message>
        <source>Wrote {0}.</source>
        <translation>{0} escrito.</translation>
    </message>
</context>
<context>
    <name>RoiBar</name>
    <message>
        <source>&amp;Accept</source>
        <translation>&amp;Aceptar</translation>
    </message>
    <message>
        <source>Lea&amp;ve</source>
        <translation>&amp;Dejar</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>filas de esquinas interiores</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>columnas de esquinas interiores</translation>
    </message>
    <message>
        <source>As counted between the clicks, with those clicked. State it if the count is wrong.</source>
        <translation>Según se contó entre los clics, incluidos estos. Indíquelo si la cuenta es errónea.</translation>
    </message>
    <message>
        <source>Keep these corners and go on (Enter)</source>
        <translation>Conservar estas esquinas y seguir (Intro)</translation>
    </message>
    <message>
        <source>Leave the image as it was (Esc)</source>
        <translation>Dejar la imagen como estaba (Esc)</translation>
    </message>
</context>
<context>
    <name>Saver</name>
    <message>
        <source>The program&apos;s own folder cannot be used: recent projects and work that is not saved are kept in {0}, until the computer is started anew. Check HOME.</source>
        <translation>La carpeta propia del programa no se puede usar: los proyectos recientes y el trabajo sin guardar están en {0} hasta que se reinicie el ordenador. Revise HOME.</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>Abriendo {0}</translation>
    </message>
    <message>
        <source>{0} is open in another window, too ({1}). What is saved there is not seen here; before it is replaced you are asked.</source>
        <translation>{0} está abierto también en otra ventana ({1}). Lo que se guarde allí no se ve aquí; antes de sustituirlo se le pregunta.</translation>
    </message>
    <message>
        <source>Recovering {0}</source>
        <translation>Recuperando {0}</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>Sin nombre</translation>
    </message>
    <message>
        <source>Saving {0}</source>
        <translation>Guardando {0}</translation>
    </message>
</context>
<context>
    <name>Scatters</name>
    <message>
        <source>real</source>
        <translation>real</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>sintético</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>px de referencia</translation>
    </message>
</context>
<context>
    <name>SensorFigure</name>
    <message>
        <source>How far off the camera puts a distant point in the image (one standard deviation), as the verdict has it: beside the camera that mends the findings, if there are any.
The colours: where the calibration&apos;s own uncertainty is small (dark) and large.</source>
        <translation>Cuánto desvía la cámara un punto lejano en la imagen (una desviación estándar), según el veredicto: frente a la cámara que corrige los hallazgos, si los hay.
Los colores: dónde es pequeña (oscuro) y grande la incertidumbre de la propia calibración.</translation>
    </message>
    <message>
        <source>Error of a pixel</source>
        <translation>Error de un píxel</translation>
    </message>
    <message>
        <source>Now: {0}</source>
        <translation>Ahora: {0}</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>centro</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>borde</translation>
    </message>
    <message>
        <source>worst pixel</source>
        <translation>peor píxel</translation>
    </message>
</context>
<context>
    <name>Sentences</name>
    <message>
        <source>The photographs show nothing wrong.</source>
        <translation>Las fotos no muestran ningún fallo.</translation>
    </message>
    <message>
        <source>The views do not determine the camera.</source>
        <translation>Las vistas no determinan la cámara.</translation>
    </message>
    <message>
        <source>The calibration is not finished.</source>
        <translation>La calibración no está terminada.</translation>
    </message>
    <message>
        <source>One view cannot be checked.</source>
        <translation>Una sola vista no se puede comprobar.</translation>
    </message>
    <message>
        <source>{0} views are too few.</source>
        <translation>{0} vistas son muy pocas.</translation>
    </message>
    <message>
        <source>{0} views are too few: take {1} or more, tilted in all directions.</source>
        <translation>{0} vistas son muy pocas: haga {1} o más, inclinadas en todas direcciones.</translation>
    </message>
    <message>
        <source>The camera is not known well enough: add photographs.</source>
        <translation>La cámara no se conoce lo bastante bien: añada fotografías.</translation>
    </message>
    <message>
        <source>Nothing needs to be done: the camera is known to {0} px.</source>
        <translation>No hay que hacer nada: la cámara se conoce a {0} px.</translation>
    </message>
    <message>
        <source>The camera is known to {0} px.</source>
        <translation>La cámara se conoce a {0} px.</translation>
    </message>
    <message>
        <source>The photographs show nothing wrong, but the camera is known to {0} px only: add photographs.</source>
        <translation>Las fotografías no muestran nada malo, pero la cámara solo se conoce a {0} px: añada fotografías.</translation>
    </message>
    <message>
        <source>Nothing is wrong where corners were seen: the camera is known to {0} px.</source>
        <translation>Donde se vieron esquinas no hay nada malo: la cámara se conoce a {0} px.</translation>
    </message>
    <message>
        <source>Beyond them it is known to {0} px: hold the board closer to the image&apos;s edges.</source>
        <translation>Fuera de ellas se conoce a {0} px: acerque el tablero a los bordes de la imagen.</translation>
    </message>
    <message>
        <source>Beyond them it is not known: hold the board closer to the image&apos;s edges.</source>
        <translation>Fuera de ellas no se conoce: acerque el tablero a los bordes de la imagen.</translation>
    </message>
    <message>
        <source>Add views with the board tilted by {0} to {1} degrees in different directions and all over the image; six good ones are enough.</source>
        <translation>Añada vistas con el tablero inclinado de {0} a {1} grados en distintas direcciones y por toda la imagen; bastan seis buenas.</translation>
    </message>
    <message>
        <source>The views are too few, or too much alike.</source>
        <translation>Las vistas son muy pocas, o demasiado parecidas.</translation>
    </message>
    <message>
        <source>Your board is not printed true.</source>
        <translation>Su tablero no está impreso a medida.</translation>
    </message>
    <message>
        <source>Your board is not flat.</source>
        <translation>Su tablero no es plano.</translation>
    </message>
    <message>
        <source>Your board is not flat, or not printed true.</source>
        <translation>Su tablero no es plano, o no está impreso a medida.</translation>
    </message>
    <message>
        <source>Your board is not flat ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>Su tablero no es plano ({0} mm): se estimó su forma; errores {1} veces menores.</translation>
    </message>
    <message>
        <source>Your board is not printed true ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>Su tablero no está impreso a medida ({0} mm): se estimó su forma; errores {1} veces menores.</translation>
    </message>
    <message>
        <source>The lens model {0} does not follow this lens.</source>
        <translation>El modelo de lente {0} no sigue a esta lente.</translation>
    </message>
    <message>
        <source>{0} does not belong to the others.</source>
        <translation>{0} no encaja con las demás.</translation>
    </message>
    <message>
        <source>{0} do not belong to the others.</source>
        <translation>{0} no encajan con las demás.</translation>
    </message>
    <message>
        <source>{0} is blurred, which does no harm here.</source>
        <translation>{0} está borrosa, lo que aquí no perjudica.</translation>
    </message>
    <message>
        <source>{0} are blurred, which does no harm here.</source>
        <translation>{0} están borrosas, lo que aquí no perjudica.</translation>
    </message>
    <message>
        <source>The images were scaled, by the camera or a program.</source>
        <translation>Las imágenes se escalaron, por la cámara o por un programa.</translation>
    </message>
    <message>
        <source>One view does not determine a camera, which leaves {0} unknown.</source>
        <translation>Una vista no determina una cámara: {0} queda sin conocer.</translation>
    </message>
    <message>
        <source>The focal length differs between the views.</source>
        <translation>La distancia focal difiere entre las vistas.</translation>
    </message>
    <message>
        <source>Switch autofocus and stabilisation off, and do not touch zoom and focus.</source>
        <translation>Desactive el autoenfoque y la estabilización, y no toque zoom ni enfoque.</translation>
    </message>
    <message>
        <source>Some views show the corners less well than the others.</source>
        <translation>Algunas vistas muestran las esquinas peor que las demás.</translation>
    </message>
    <message>
        <source>Tool ± {0} mm, ± {1} degrees (k = 2); robot {2} %, camera {3} %, from {4} poses</source>
        <translation>Herramienta ± {0} mm, ± {1} grados (k = 2); robot {2} %, cámara {3} %, con {4} poses</translation>
    </message>
    <message>
        <source>The robot&apos;s poses are {0}.</source>
        <translation>Las poses del robot son {0}.</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in degrees, {1}</source>
        <translation>ángulos a, b, c de {0} en grados, {1}</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in radians, {1}</source>
        <translation>ángulos a, b, c de {0} en radianes, {1}</translation>
    </message>
    <message>
        <source>rotation vectors in degrees, {0}</source>
        <translation>vectores de rotación en grados, {0}</translation>
    </message>
    <message>
        <source>rotation vectors in radians, {0}</source>
        <translation>vectores de rotación en radianes, {0}</translation>
    </message>
    <message>
        <source>quaternions {0}</source>
        <translation>cuaterniones {0}</translation>
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
        <translation>matrices por filas, {0}</translation>
    </message>
    <message>
        <source>matrices column by column, {0}</source>
        <translation>matrices por columnas, {0}</translation>
    </message>
    <message>
        <source>rotations transposed, {0}</source>
        <translation>rotaciones traspuestas, {0}</translation>
    </message>
    <message>
        <source>millimetres, {0}</source>
        <translation>milímetros, {0}</translation>
    </message>
    <message>
        <source>metres, {0}</source>
        <translation>metros, {0}</translation>
    </message>
    <message>
        <source>base from hand</source>
        <translation>base desde mano</translation>
    </message>
    <message>
        <source>hand from base</source>
        <translation>mano desde base</translation>
    </message>
    <message>
        <source>camera in the hand</source>
        <translation>cámara en la mano</translation>
    </message>
    <message>
        <source>camera beside the robot</source>
        <translation>cámara junto al robot</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm.</source>
        <translation>Leídas así, el tablero se dispersa {0} mm.</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm, and by {1} mm in any other way.</source>
        <translation>Leídas así, el tablero se dispersa {0} mm, y {1} mm de cualquier otro modo.</translation>
    </message>
    <message>
        <source>A pose of the robot is off by {0} mm along each axis and by {1} degrees about each, one standard deviation.</source>
        <translation>Una pose del robot se desvía {0} mm a lo largo de cada eje y {1} grados en torno a cada uno, una desviación estándar.</translation>
    </message>
    <message>
        <source>The corners are off by {0} px.</source>
        <translation>Las esquinas se desvían {0} px.</translation>
    </message>
    <message>
        <source>The poses fit as well as {0}.</source>
        <translation>Las poses encajan igual de bien como {0}.</translation>
    </message>
    <message>
        <source>Turn the hand about more axes, or state where the camera is (above).</source>
        <translation>Gire la mano en torno a más ejes, o indique arriba dónde está la cámara.</translation>
    </message>
    <message>
        <source>Correct the file.</source>
        <translation>Corrija el archivo.</translation>
    </message>
    <message>
        <source>{0} have the same pose of the robot: if it moved between them, the file is wrong.</source>
        <translation>{0} tienen la misma pose del robot: si se movió entre ellas, el archivo está mal.</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the hand.</source>
        <translation>Abierto: la cámara puede estar girada en torno a {0} de la mano.</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the base.</source>
        <translation>Abierto: la cámara puede estar girada en torno a {0} de la base.</translation>
    </message>
    <message>
        <source>any axis</source>
        <translation>cualquier eje</translation>
    </message>
    <message>
        <source>Turn the hand about another axis as well, or move it without turning.</source>
        <translation>Gire la mano también en torno a otro eje, o muévala sin girarla.</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the hand.</source>
        <translation>Abierto: la cámara puede estar desplazada a lo largo de {0} de la mano.</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the base.</source>
        <translation>Abierto: la cámara puede estar desplazada a lo largo de {0} de la base.</translation>
    </message>
    <message>
        <source>All else is determined, and no ± counts this.</source>
        <translation>Todo lo demás está determinado, y ningún ± lo cuenta.</translation>
    </message>
    <message>
        <source>Turn the hand about {0}, or measure it.</source>
        <translation>Gire la mano en torno a {0}, o mídalo.</translation>
    </message>
    <message>
        <source>a second axis</source>
        <translation>un segundo eje</translation>
    </message>
    <message>
        <source>two axes</source>
        <translation>dos ejes</translation>
    </message>
    <message>
        <source>other axes</source>
        <translation>otros ejes</translation>
    </message>
    <message>
        <source>The robot&apos;s pose does not fit in {0}: another moment, or a mistake in the file.</source>
        <translation>La pose del robot no encaja en {0}: otro momento, o un error en el archivo.</translation>
    </message>
    <message>
        <source>Left out: {0}</source>
        <translation>Dejado fuera: {0}</translation>
    </message>
    <message>
        <source>No ± counts the camera&apos;s errors: its file does not state them.</source>
        <translation>Ningún ± cuenta los errores de la cámara: su archivo no los indica.</translation>
    </message>
    <message>
        <source>The robot&apos;s poses do not fit the photographs, however they are read: at best the board scatters by {0} mm in the robot&apos;s frame.</source>
        <translation>Las poses del robot no encajan con las fotos, se lean como se lean: en el mejor caso el tablero se dispersa {0} mm en el sistema del robot.</translation>
    </message>
    <message>
        <source>Check that they are the poses of these photographs in this order, and that board and camera stayed fixed, one to the hand and the other to the base.</source>
        <translation>Compruebe que son las poses de estas fotos en este orden, y que tablero y cámara siguieron fijos, uno a la mano y otro a la base.</translation>
    </message>
    <message>
        <source>By the robot&apos;s motions the board&apos;s squares are {0} times as long as stated.</source>
        <translation>Según los movimientos del robot, los cuadros del tablero miden {0} veces lo indicado.</translation>
    </message>
    <message>
        <source>State the side of a square as it was printed.</source>
        <translation>Indique el lado de un cuadro tal como se imprimió.</translation>
    </message>
    <message>
        <source>There are {0} different poses of the robot with a board; hand and eye need at least {1}.</source>
        <translation>Hay {0} poses distintas del robot con un tablero; mano y ojo necesitan al menos {1}.</translation>
    </message>
    <message>
        <source>Photograph the board from ten poses or more, turned about two axes at least.</source>
        <translation>Fotografíe el tablero desde diez poses o más, giradas en torno a dos ejes al menos.</translation>
    </message>
    <message>
        <source>{0} has {1} poses, and there are {2} photographs.</source>
        <translation>{0} tiene {1} poses, y hay {2} fotos.</translation>
    </message>
    <message>
        <source>Give a pose for each photograph, in the order of their names, or name the photographs in the first column.</source>
        <translation>Dé una pose para cada foto, en el orden de sus nombres, o nombre las fotos en la primera columna.</translation>
    </message>
    <message>
        <source>{0} names none of the photographs.</source>
        <translation>{0} no nombra ninguna de las fotos.</translation>
    </message>
    <message>
        <source>Name them as they are called, as {0}.</source>
        <translation>Nómbrelas como se llaman, como {0}.</translation>
    </message>
    <message>
        <source>{0} holds no poses.</source>
        <translation>{0} no contiene poses.</translation>
    </message>
    <message>
        <source>{0} is {1} ms {2} than {3}.</source>
        <translation>{0} va {1} ms {2} que {3}.</translation>
    </message>
    <message>
        <source>later</source>
        <translation>más tarde</translation>
    </message>
    <message>
        <source>earlier</source>
        <translation>antes</translation>
    </message>
    <message>
        <source>Photographs of {0} cameras: {1}.</source>
        <translation>Fotos de {0} cámaras: {1}.</translation>
    </message>
    <message>
        <source>Paired by their {0}: {1} of several cameras, the first {2}.</source>
        <translation>Emparejadas por {0}: {1} de varias cámaras, el primero {2}.</translation>
    </message>
    <message>
        <source>before the place {0}</source>
        <translation>antes de la posición {0}</translation>
    </message>
    <message>
        <source>The order is shifted: each pose stands {0}, and was used for the photograph that it fits.</source>
        <translation>El orden está desplazado: cada pose está {0}, y se usó para la foto con la que encaja.</translation>
    </message>
    <message>
        <source>one line early</source>
        <translation>una línea antes</translation>
    </message>
    <message>
        <source>one line late</source>
        <translation>una línea después</translation>
    </message>
    <message>
        <source>Leave it out {0}.</source>
        <translation>Déjela fuera {0}.</translation>
    </message>
    <message>
        <source>below</source>
        <translation>abajo</translation>
    </message>
    <message>
        <source>names</source>
        <translation>sus nombres</translation>
    </message>
    <message>
        <source>numbers</source>
        <translation>sus números</translation>
    </message>
    <message>
        <source>times, which are at most {0} ms apart</source>
        <translation>sus tiempos, a lo sumo a {0} ms entre sí</translation>
    </message>
    <message>
        <source>1 instant</source>
        <translation>1 instante</translation>
    </message>
    <message>
        <source>{0} instants</source>
        <translation>{0} instantes</translation>
    </message>
    <message>
        <source>Without a partner: {0}.</source>
        <translation>Sin pareja: {0}.</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px.</source>
        <translation>{0} cámaras, {1}: juntas dejan {2} px, cada una sola {3} px.</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px, {4} times less.</source>
        <translation>{0} cámaras, {1}: juntas dejan {2} px, cada una sola {3} px, {4} veces menos.</translation>
    </message>
    <message>
        <source>They agree.</source>
        <translation>Concuerdan.</translation>
    </message>
    <message>
        <source>The instants disagree.</source>
        <translation>Los instantes discrepan.</translation>
    </message>
    <message>
        <source>Single instants have {0} mm from where most have it beside {1}; the corners&apos; noise explains {2} mm.</source>
        <translation>Instantes sueltos sitúan {0} mm de donde la sitúa la mayoría junto a {1}; el ruido de las esquinas explica {2} mm.</translation>
    </message>
    <message>
        <source>Photographs of one instant were not taken at quite the same moment, or the board bends in the hand.</source>
        <translation>Las fotos de un instante no se tomaron del todo a la vez, o el tablero se dobla en la mano.</translation>
    </message>
    <message>
        <source>Each ± counts it: put the board down for each picture, or trigger the cameras together.</source>
        <translation>Cada ± lo cuenta: apoye el tablero para cada imagen, o dispare las cámaras a la vez.</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} earlier: nothing above holds.</source>
        <translation>Las fotos de {0} corresponden a las de {1}, {2} antes: nada de lo anterior vale.</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} later: nothing above holds.</source>
        <translation>Las fotos de {0} corresponden a las de {1}, {2} después: nada de lo anterior vale.</translation>
    </message>
    <message>
        <source>Pair them so.</source>
        <translation>Emparéjelas así.</translation>
    </message>
    <message>
        <source>Exchanged with those of {0}: {1}.</source>
        <translation>Intercambiadas con las de {0}: {1}.</translation>
    </message>
    <message>
        <source>They are left out; give them back their names.</source>
        <translation>Quedan fuera; devuélvales sus nombres.</translation>
    </message>
    <message>
        <source>The squares were counted {0} times as long as in the others in {1}, and the photographs of {2} beside them.</source>
        <translation>En {1}, y en las fotos de {2} junto a ellas, los cuadros se cuentan {0} veces más largos que en las demás.</translation>
    </message>
    <message>
        <source>They are left out: is that another board, or another --square?</source>
        <translation>Quedan fuera: ¿es otro tablero, u otro lado de cuadro?</translation>
    </message>
    <message>
        <source>{0} stands {1} mm otherwise beside {2} from {3} on.</source>
        <translation>{0} está {1} mm en otro lugar junto a {2} a partir de {3}.</translation>
    </message>
    <message>
        <source>Calibrate the photographs before and after it by themselves.</source>
        <translation>Calibre por separado las fotos anteriores y posteriores.</translation>
    </message>
    <message>
        <source>The boards stand {0} mm otherwise to each other from {1} on.</source>
        <translation>Los tableros están {0} mm de otro modo entre sí a partir de {1}.</translation>
    </message>
    <message>
        <source>Fasten them, or calibrate the photographs before and after it by themselves.</source>
        <translation>Fíjelos, o calibre por separado las fotos anteriores y posteriores.</translation>
    </message>
    <message>
        <source>The focal length of {0} is {1} times as long from {2} on: it was refocused or zoomed.</source>
        <translation>La distancia focal de {0} es {1} veces mayor a partir de {2}: se reenfocó o se cambió el zoom.</translation>
    </message>
    <message>
        <source>Left out, as the board is elsewhere than in the other cameras&apos; photographs of the instant: {0}.</source>
        <translation>Fuera, pues el tablero está en otro lugar que en las fotos de las demás cámaras del instante: {0}.</translation>
    </message>
    <message>
        <source>Were they taken at another instant?</source>
        <translation>¿Se tomaron en otro instante?</translation>
    </message>
    <message>
        <source>Those that agree least with the other cameras: {0}.</source>
        <translation>Las que menos concuerdan con las demás cámaras: {0}.</translation>
    </message>
    <message>
        <source>Counted from another end of the board, and turned back: {0}.</source>
        <translation>Contadas desde otro extremo del tablero, y giradas de vuelta: {0}.</translation>
    </message>
    <message>
        <source>Where {0} stands beside {1} is open: no two cameras saw them at one instant.</source>
        <translation>Dónde está {0} junto a {1} queda abierto: ningún par de cámaras los vio en un mismo instante.</translation>
    </message>
    <message>
        <source>Nothing else depends on it.</source>
        <translation>Nada más depende de ello.</translation>
    </message>
    <message>
        <source>{0} deviates from its drawing by {1} mm rms, at most {2} mm.</source>
        <translation>{0} se aparta {1} mm (RMS) de su dibujo, a lo sumo {2} mm.</translation>
    </message>
    <message>
        <source>board {0}</source>
        <translation>tablero {0}</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>Tablero {0}</translation>
    </message>
    <message>
        <source>The board</source>
        <translation>El tablero</translation>
    </message>
    <message>
        <source>The board moved while the cameras&apos; clocks did not agree: with one offset in time for each camera they leave {0} px.</source>
        <translation>El tablero se movió mientras los relojes de las cámaras no concordaban: con un desfase por cámara dejan {0} px.</translation>
    </message>
    <message>
        <source>--offsets estimates these.</source>
        <translation>En la configuración se puede estimar.</translation>
    </message>
    <message>
        <source>The kind or the size of {0} is not stated.</source>
        <translation>No se ha indicado el tipo o el tamaño de {0}.</translation>
    </message>
    <message>
        <source>State both of each board (--target and --board on the command line).</source>
        <translation>Indique ambos de cada tablero.</translation>
    </message>
    <message>
        <source>Nothing is stated of {0} that tells it from the other boards.</source>
        <translation>No se indica nada de {0} que lo distinga de los demás tableros.</translation>
    </message>
    <message>
        <source>Several boards have markers or tags: state --target and --board of each, and the --dictionary of a ChArUco board, the --family of one with AprilTags.</source>
        <translation>Varios tableros llevan marcadores o etiquetas: indique tipo y tamaño de cada uno, y el diccionario de un tablero ChArUco o la familia de uno con AprilTags.</translation>
    </message>
    <message>
        <source>The markers {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>Los marcadores {0} a {1} de {2} están en {3} y en {4}: las fotos no distinguen los tableros.</translation>
    </message>
    <message>
        <source>The tags {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>Las etiquetas {0} a {1} de {2} están en {3} y en {4}: las fotos no distinguen los tableros.</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that never see the board together: {1}.</source>
        <translation>Las cámaras se dividen en {0} grupos que nunca ven juntos el tablero: {1}.</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that nothing joins: {1}.</source>
        <translation>Las cámaras se dividen en {0} grupos que nada une: {1}.</translation>
    </message>
    <message>
        <source>{0} shows no board of {1} in any photograph, and {2} does.</source>
        <translation>{0} no muestra ningún tablero de {1} en ninguna foto, y {2} sí.</translation>
    </message>
    <message>
        <source>A rig takes one board before all cameras: photograph the same one, or leave out the camera that saw another.</source>
        <translation>Un conjunto usa un tablero ante todas las cámaras: fotografíe el mismo, o deje fuera la cámara que vio otro.</translation>
    </message>
</context>
<context>
    <name>SeriesDialog</name>
    <message>
        <source>Series of calibrations</source>
        <translation>Serie de calibraciones</translation>
    </message>
    <message>
        <source>&amp;Add results…</source>
        <translation>&amp;Añadir resultados…</translation>
    </message>
    <message>
        <source>The quantity that varies</source>
        <translation>La magnitud que varía</translation>
    </message>
    <message>
        <source>zoom</source>
        <translation>zoom</translation>
    </message>
    <message>
        <source>focus</source>
        <translation>enfoque</translation>
    </message>
    <message>
        <source>temperature</source>
        <translation>temperatura</translation>
    </message>
    <message>
        <source>date</source>
        <translation>fecha</translation>
    </message>
    <message>
        <source>&amp;Table of values…</source>
        <translation>&amp;Tabla de valores…</translation>
    </message>
    <message>
        <source>A CSV file with the columns file,value; temperatures in °C. Without one focal lengths and dates are read from the photographs.</source>
        <translation>Un archivo CSV con las columnas file,value; temperaturas en °C. Sin él, distancias focales y fechas se leen de las fotos.</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parámetro</translation>
    </message>
    <message>
        <source>Value at which the camera is shown</source>
        <translation>Valor en que se muestra la cámara</translation>
    </message>
    <message>
        <source>Format</source>
        <translation>Formato</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>&amp;Exportar…</translation>
    </message>
    <message>
        <source>Add the result.json of each setting of one camera: three or more.</source>
        <translation>Añada el result.json de cada ajuste de una cámara: tres o más.</translation>
    </message>
    <message>
        <source>by</source>
        <translation>por</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>Resultados</translation>
    </message>
    <message>
        <source>Camera at a value</source>
        <translation>Cámara en un valor</translation>
    </message>
    <message>
        <source>Camera at</source>
        <translation>Cámara en</translation>
    </message>
    <message>
        <source>as</source>
        <translation>como</translation>
    </message>
    <message>
        <source>Results (*.json)</source>
        <translation>Resultados (*.json)</translation>
    </message>
    <message>
        <source>Table of values</source>
        <translation>Tabla de valores</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tablas (*.csv)</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>calculando…</translation>
    </message>
    <message>
        <source>Fitting the series</source>
        <translation>Ajustando la serie</translation>
    </message>
    <message>
        <source>From {0} to {1}; empty to write a profile of all focal lengths</source>
        <translation>De {0} a {1}; vacío para escribir un perfil de todas las focales</translation>
    </message>
    <message>
        <source>File</source>
        <translation>Archivo</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>From the first</source>
        <translation>De la primera</translation>
    </message>
    <message>
        <source>Difference from the first camera after a rotation, rms</source>
        <translation>Diferencia con la primera cámara tras un giro, RMS</translation>
    </message>
    <message>
        <source>Explained</source>
        <translation>Explicado</translation>
    </message>
    <message>
        <source>Difference that the calibrations&apos; uncertainties explain</source>
        <translation>Diferencia que explican las incertidumbres de las calibraciones</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>Probabilidad</translation>
    </message>
    <message>
        <source>Of a difference as large as this one if the camera has not changed</source>
        <translation>De una diferencia así de grande si la cámara no ha cambiado</translation>
    </message>
    <message>
        <source>Changed</source>
        <translation>Cambió</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>Usado</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>sí</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>omitido</translation>
    </message>
    <message>
        <source>Reason</source>
        <translation>Motivo</translation>
    </message>
    <message>
        <source>no</source>
        <translation>no</translation>
    </message>
    <message>
        <source>{0} is no value of {1}.</source>
        <translation>{0} no es un valor de {1}.</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Valor</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Unidad</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exportar</translation>
    </message>
    <message>
        <source>Saved as {0}. {1}</source>
        <translation>Guardado como {0}. {1}</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>Escribiendo {0}</translation>
    </message>
</context>
<context>
    <name>Session</name>
    <message>
        <source>Out of date, as images or board have changed: calibrate again.</source>
        <translation>Anticuado, pues cambiaron imágenes o tablero: calibre de nuevo.</translation>
    </message>
    <message>
        <source>Out of date, as settings have changed: calibrate again.</source>
        <translation>Anticuado, pues cambiaron los ajustes: calibre de nuevo.</translation>
    </message>
</context>
<context>
    <name>SettingsPanel</name>
    <message>
        <source>&amp;Leave outliers out</source>
        <translation>&amp;Omitir valores atípicos</translation>
    </message>
    <message>
        <source>Remove corners and views that do not fit from the images, as by hand: undo brings them back. The result names them.</source>
        <translation>Quitar de las imágenes esquinas y vistas que no encajan, como a mano: deshacer las trae de nuevo. El resultado las nombra.</translation>
    </message>
    <message>
        <source>&amp;Weigh views by their noise</source>
        <translation>&amp;Ponderar vistas por su ruido</translation>
    </message>
    <message>
        <source>Make the camera bette&amp;r</source>
        <translation>Mejo&amp;rar la cámara</translation>
    </message>
    <message>
        <source>Carry out what needs no new photograph and makes errors smaller by a fifth or more: another lens model or board shape where these are automatic, and leaving out corners and views that do not fit. Undo goes back through it.</source>
        <translation>Hacer lo que no necesita fotos nuevas y reduce los errores un quinto o más: otro modelo de lente o forma de tablero donde son automáticos, y omitir esquinas y vistas que no encajan. Deshacer lo recorre hacia atrás.</translation>
    </message>
    <message>
        <source>Search a&amp;gain with the camera</source>
        <translation>Buscar de nuevo con la &amp;cámara</translation>
    </message>
    <message>
        <source>Once the camera is known, search the images without a board and the boards found in part again, and calibrate from what that gains.</source>
        <translation>Conocida la cámara, buscar otra vez en imágenes sin tablero y en tableros hallados en parte, y calibrar con lo que se gana.</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>Calibrar de nuevo</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation>automático</translation>
    </message>
    <message>
        <source>The paper&apos;s model, unless views that the models have not seen demand another. The result says why. Slower.</source>
        <translation>El modelo del artículo, salvo que vistas que los modelos no han visto exijan otro. El resultado dice por qué. Más lento.</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>Modelo de lente</translation>
    </message>
    <message>
        <source>Values of held parameters</source>
        <translation>Valores de parámetros fijos</translation>
    </message>
    <message>
        <source>Parameters that are held at values of their own, as fx=650, p1=0. Of the others that are held coefficients are 0, the centre is the image&apos;s and focal lengths are those of the closed form.</source>
        <translation>Parámetros fijados en valores propios, como fx=650, p1=0. De los demás fijos, los coeficientes son 0, el centro es el de la imagen y las focales son las de la forma cerrada.</translation>
    </message>
    <message>
        <source>&amp;Minimise</source>
        <translation>&amp;Minimizar</translation>
    </message>
    <message>
        <source>Held at</source>
        <translation>Fijo en</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>Cámara</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Método</translation>
    </message>
    <message>
        <source>Estimate</source>
        <translation>Estimar</translation>
    </message>
    <message>
        <source>The chosen method has nothing else to minimise.</source>
        <translation>El método elegido no tiene otra cosa que minimizar.</translation>
    </message>
    <message>
        <source>The error in the image takes any board.</source>
        <translation>El error en la imagen admite cualquier tablero.</translation>
    </message>
    <message>
        <source>The chosen method takes every board as it is drawn.</source>
        <translation>El método elegido toma todo tablero como dibujado.</translation>
    </message>
    <message>
        <source>Only the error in the image takes weights.</source>
        <translation>Solo el error en la imagen admite pesos.</translation>
    </message>
    <message>
        <source>Poor views then spoil less. Best with an estimated shape of the board, which would else pass for noise.</source>
        <translation>Las vistas malas estropean menos. Mejor con la forma del tablero estimada, que si no pasaría por ruido.</translation>
    </message>
    <message>
        <source>The chosen method takes all corners as equally good.</source>
        <translation>El método elegido toma todas las esquinas por igual de buenas.</translation>
    </message>
    <message>
        <source>The chosen method has its own lens model: what its authors corrected.</source>
        <translation>El método elegido tiene su propio modelo de lente: lo que corrigieron sus autores.</translation>
    </message>
    <message>
        <source>The formulation of the paper has its own lens model, with a radius in pixels.</source>
        <translation>La formulación del artículo tiene su propio modelo de lente, con un radio en píxeles.</translation>
    </message>
    <message>
        <source>How the lens bends what a pinhole would image; the result is of it.</source>
        <translation>Cómo dobla la lente lo que formaría un estenopo; el resultado es de ella.</translation>
    </message>
    <message>
        <source>Estimate {0}; otherwise it is held, coefficients at 0.</source>
        <translation>Estimar {0}; si no, queda fijo, coeficientes en 0.</translation>
    </message>
    <message>
        <source>The chosen method cannot estimate {0}.</source>
        <translation>El método elegido no puede estimar {0}.</translation>
    </message>
    <message>
        <source>Calibration settings</source>
        <translation>Ajustes de calibración</translation>
    </message>
</context>
<context>
    <name>SetupSheet</name>
    <message>
        <source>Board</source>
        <translation>Tablero</translation>
    </message>
    <message>
        <source>What is photographed</source>
        <translation>Lo que se fotografía</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Lente</translation>
    </message>
    <message>
        <source>Which model describes the lens</source>
        <translation>Qué modelo describe la lente</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>Límites</translation>
    </message>
    <message>
        <source>What is demanded of the camera</source>
        <translation>Qué se exige de la cámara</translation>
    </message>
    <message>
        <source>For experts</source>
        <translation>Para expertos</translation>
    </message>
    <message>
        <source>How to calibrate</source>
        <translation>Cómo calibrar</translation>
    </message>
</context>
<context>
    <name>SourceList</name>
    <message>
        <source>&amp;Another camera</source>
        <translation>&amp;Otra cámara</translation>
    </message>
    <message>
        <source>&amp;Remove</source>
        <translation>&amp;Quitar</translation>
    </message>
    <message>
        <source>Several cameras that stand fast to each other take each picture together</source>
        <translation>Varias cámaras fijas entre sí toman cada imagen a la vez</translation>
    </message>
    <message>
        <source>Camera {0}</source>
        <translation>Cámara {0}</translation>
    </message>
    <message>
        <source>A camera at this computer, or the address of one in the network (rtsp://…, http://…), or the folder that a camera&apos;s program fills</source>
        <translation type="unfinished">Una cámara de este ordenador, la dirección de una en la red (rtsp://…, http://…), o la carpeta que llena el programa de una cámara</translation>
    </message>
    <message>
        <source>camera {0}</source>
        <translation type="unfinished">cámara {0}</translation>
    </message>
</context>
<context>
    <name>SquareRow</name>
    <message>
        <source>Only lengths depend on it, no pixel does. Until it is confirmed, every length holds on this condition.</source>
        <translation>Solo las longitudes dependen de ello, ningún píxel. Hasta confirmarlo, toda longitud vale bajo esta condición.</translation>
    </message>
    <message>
        <source>Confirm</source>
        <translation>Confirmar</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>Tamaño de los cuadros</translation>
    </message>
    <message>
        <source>Confirm the size of squares</source>
        <translation>Confirmar el tamaño de los cuadros</translation>
    </message>
    <message>
        <source>Lengths hold: you have confirmed {0:g} {1}.</source>
        <translation>Las longitudes valen: ha confirmado {0:g} {1}.</translation>
    </message>
    <message>
        <source>How far apart are the circles? {2}, {0} × {1}.</source>
        <translation>¿A qué distancia están los círculos? {2}, {0} × {1}.</translation>
    </message>
    <message>
        <source>How far apart are the circles? The board is being counted.</source>
        <translation>¿A qué distancia están los círculos? Se cuenta el tablero.</translation>
    </message>
    <message>
        <source>How far apart are the circles? Their number is not known: state it in the Set-up.</source>
        <translation>¿A qué distancia están los círculos? No se sabe cuántos son: indíquelo en los Ajustes.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? {2}, {0} × {1} corners.</source>
        <translation>¿Cuánto miden los lados de las etiquetas? {2}, {0} × {1} esquinas.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? The board is being counted.</source>
        <translation>¿Cuánto miden los lados de las etiquetas? Se cuenta el tablero.</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? Their number is not known: state it in the Set-up.</source>
        <translation>¿Cuánto miden los lados de las etiquetas? No se sabe cuántas son: indíquelo en los Ajustes.</translation>
    </message>
    <message>
        <source>How long are the squares? {2}, {0} × {1} inner corners.</source>
        <translation>¿Cuánto miden los cuadros? {2}, {0} × {1} esquinas interiores.</translation>
    </message>
    <message>
        <source>How long are the squares? The board is being counted.</source>
        <translation>¿Cuánto miden los cuadros? Se cuenta el tablero.</translation>
    </message>
    <message>
        <source>How long are the squares? Their number is not known: state it in the Set-up.</source>
        <translation>¿Cuánto miden los cuadros? No se sabe cuántos son: indíquelo en los Ajustes.</translation>
    </message>
    <message>
        <source>Distance of circles</source>
        <translation>Distancia de los círculos</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>Lado de una etiqueta</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>Lado de un cuadro</translation>
    </message>
    <message>
        <source>Confirm {0:g} {1}</source>
        <translation>Confirmar {0:g} {1}</translation>
    </message>
    <message>
        <source>This length is confirmed already; state another one first.</source>
        <translation>Esta longitud ya está confirmada; indique antes otra.</translation>
    </message>
</context>
<context>
    <name>StageOnePanel</name>
    <message>
        <source>Stage I</source>
        <translation>Etapa I</translation>
    </message>
    <message>
        <source>What each view says of the camera by itself: the paper&apos;s first stage.</source>
        <translation>Lo que cada vista dice de la cámara por sí sola: la primera etapa del artículo.</translation>
    </message>
    <message>
        <source>aspect ratio r</source>
        <translation>relación de aspecto r</translation>
    </message>
    <message>
        <source>g(r)</source>
        <translation>g(r)</translation>
    </message>
    <message>
        <source>The cosines&apos; equation of the selected view: where it is zero, r = fy / fx.
It has no value where the view&apos;s tilt does not determine it.</source>
        <translation>La ecuación de los cosenos de la vista elegida: donde es cero, r = fy / fx.
No tiene valor donde la inclinación de la vista no lo determina.</translation>
    </message>
    <message>
        <source>view</source>
        <translation>vista</translation>
    </message>
    <message>
        <source>aspect ratio fy / fx</source>
        <translation>relación fy / fx</translation>
    </message>
    <message>
        <source>The root of each view. Views near fronto-parallel, or tilted about one axis,
give none or a poor one: Stage II does not depend on them.</source>
        <translation>La raíz de cada vista. Las vistas casi frontales, o inclinadas en torno a un eje,
no dan ninguna o una mala: la Etapa II no depende de ellas.</translation>
    </message>
    <message>
        <source>No view determines its aspect ratio.</source>
        <translation>Ninguna vista determina su relación de aspecto.</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r = {1:.4f}</source>
        <translation>{0}&lt;br&gt;r = {1:.4f}</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r is not determined</source>
        <translation>{0}&lt;br&gt;r indeterminado</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Pasos</translation>
    </message>
    <message>
        <source>Principal point right of the array&apos;s centre</source>
        <translation>Punto principal a la derecha del centro del sensor</translation>
    </message>
    <message>
        <source>Principal point above the centre</source>
        <translation>Punto principal por encima del centro</translation>
    </message>
    <message>
        <source>First radial coefficient</source>
        <translation>Primer coeficiente radial</translation>
    </message>
    <message>
        <source>Aspect ratio: root of the cosines&apos; equation</source>
        <translation>Relación de aspecto: raíz de la ecuación de los cosenos</translation>
    </message>
    <message>
        <source>Focal length</source>
        <translation>Distancia focal</translation>
    </message>
    <message>
        <source>Iterations of Levenberg-Marquardt</source>
        <translation>Iteraciones de Levenberg-Marquardt</translation>
    </message>
    <message>
        <source>px′</source>
        <translation>px′</translation>
    </message>
    <message>
        <source>Residual on the reference plane; px′ are its pixels, 30 to a square</source>
        <translation>Residuo en el plano de referencia; px′ son sus píxeles, 30 por cuadro</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Vista</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate, from RMS, corners and 11 unknowns</source>
        <translation>Desviación típica de una coordenada, a partir del RMS, las esquinas y 11 incógnitas</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation type="unfinished">Esquinas</translation>
    </message>
    <message>
        <source>Number of the view&apos;s corners</source>
        <translation>Número de esquinas de la vista</translation>
    </message>
    <message>
        <source>no convergence</source>
        <translation>sin convergencia</translation>
    </message>
    <message>
        <source>Far from the other views: {0}</source>
        <translation>Lejos de las otras vistas: {0}</translation>
    </message>
</context>
<context>
    <name>SyntheticPanel</name>
    <message>
        <source>Synthetic check</source>
        <translation>Prueba sintética</translation>
    </message>
    <message>
        <source>Whether the method finds this camera again.</source>
        <translation>Si el método reencuentra esta cámara.</translation>
    </message>
    <message>
        <source>&amp;Render and calibrate</source>
        <translation>&amp;Generar y calibrar</translation>
    </message>
    <message>
        <source>Renders every view from the result, finds the corners again, adds the noise that
was found and calibrates: what must come back is known exactly.</source>
        <translation>Genera las vistas a partir del resultado, halla las esquinas, añade el ruido
encontrado y calibra: lo que debe salir se conoce exactamente.</translation>
    </message>
    <message>
        <source>Rendering the views and searching them…</source>
        <translation>Generando las vistas y buscando en ellas…</translation>
    </message>
    <message>
        <source>real</source>
        <translation>real</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>sintético</translation>
    </message>
    <message>
        <source>Table</source>
        <translation>Tabla</translation>
    </message>
    <message>
        <source>Images</source>
        <translation>Imágenes</translation>
    </message>
    <message>
        <source>Poses</source>
        <translation>Poses</translation>
    </message>
    <message>
        <source>Residuals</source>
        <translation>Residuos</translation>
    </message>
    <message>
        <source>Histograms</source>
        <translation>Histogramas</translation>
    </message>
    <message>
        <source>Table 3 of the paper</source>
        <translation>Tabla 3 del artículo</translation>
    </message>
    <message>
        <source>The board&apos;s pattern is not known, so its views cannot be rendered.</source>
        <translation>No se conoce el patrón del tablero, así que sus vistas no se pueden generar.</translation>
    </message>
    <message>
        <source>Would the method find this camera again, if it were just so?</source>
        <translation>¿Hallaría el método esta cámara de nuevo, si fuera justo así?</translation>
    </message>
    <message>
        <source>{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, real images {4:.3f} ± {5:.3f}.</source>
        <translation>{0} de {1} vistas halladas de nuevo. e′ = {2:.4f} ± {3:.4f} px de referencia, imágenes reales {4:.3f} ± {5:.3f}.</translation>
    </message>
    <message>
        <source>Rendering {0}</source>
        <translation>Generando {0}</translation>
    </message>
</context>
<context>
    <name>Table</name>
    <message>
        <source>Table</source>
        <translation>Tabla</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>Copiar</translation>
    </message>
    <message>
        <source>Save as CSV…</source>
        <translation>Guardar como CSV…</translation>
    </message>
    <message>
        <source>Table of {0}</source>
        <translation>Tabla de {0}</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>Guardar tabla</translation>
    </message>
    <message>
        <source>Comma-separated values (*.csv)</source>
        <translation>Valores separados por comas (*.csv)</translation>
    </message>
</context>
<context>
    <name>TakenStrip</name>
    <message>
        <source>Pictures taken</source>
        <translation>Fotos tomadas</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>&amp;Deshacer</translation>
    </message>
    <message>
        <source>{0} · put aside</source>
        <translation>{0} · apartada</translation>
    </message>
    <message>
        <source>{0}: a camera calibrated without it is checked with it as well</source>
        <translation>{0}: con ella se comprueba también una cámara calibrada sin ella</translation>
    </message>
    <message>
        <source>&amp;Take again</source>
        <translation>&amp;Tomar de nuevo</translation>
    </message>
</context>
<context>
    <name>Tour</name>
    <message>
        <source>Leave</source>
        <translation>Salir</translation>
    </message>
    <message>
        <source>Your photographs</source>
        <translation>Sus fotos</translation>
    </message>
    <message>
        <source>The bar below each is how far its corners are from where the camera puts them. Drag the dashed line, and leave out what is above it.</source>
        <translation>La barra bajo cada una es cuánto distan sus esquinas de donde las pone la cámara. Arrastre la línea de trazos y omita lo que quede por encima.</translation>
    </message>
    <message>
        <source>One photograph</source>
        <translation>Una foto</translation>
    </message>
    <message>
        <source>The corners that were found. Where a board is missed, press Mark and click on its four outermost corners.</source>
        <translation>Las esquinas que se hallaron. Donde falte un tablero, pulse Marcar y señale sus cuatro esquinas extremas.</translation>
    </message>
    <message>
        <source>The verdict</source>
        <translation>El veredicto</translation>
    </message>
    <message>
        <source>Whether the camera can be used, and how far off a point is in the image: at the centre, at the edge, at worst, and in mm at your distance.</source>
        <translation>Si la cámara se puede usar, y cuánto se desvía un punto en la imagen: en el centro, en el borde, en el peor caso, y en mm a su distancia.</translation>
    </message>
    <message>
        <source>What was done</source>
        <translation>Qué se hizo</translation>
    </message>
    <message>
        <source>Each step that made the camera better can be undone, or says why.</source>
        <translation>Cada paso que mejoró la cámara se puede deshacer, o dice por qué.</translation>
    </message>
    <message>
        <source>Look closer</source>
        <translation>Mirar de cerca</translation>
    </message>
    <message>
        <source>Each mode fills the desk: the method step by step, the fit, the lens, the board, and images without distortion.</source>
        <translation>Cada modo llena la mesa: el método paso a paso, el ajuste, la lente, el tablero e imágenes sin distorsión.</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>Ajustes</translation>
    </message>
    <message>
        <source>The board, the lens, and limits for PASS or FAIL.</source>
        <translation>El tablero, la lente y límites para PASS o FAIL.</translation>
    </message>
    <message>
        <source>Take it with you</source>
        <translation>Llévesela</translation>
    </message>
    <message>
        <source>Export writes the camera for other programs, Report a page for people.</source>
        <translation>Exportar escribe la cámara para otros programas, Informe una página para personas.</translation>
    </message>
    <message>
        <source>Still good?</source>
        <translation>¿Aún buena?</translation>
    </message>
    <message>
        <source>Months later, drop a few new photographs on this side: they check the camera and change nothing.</source>
        <translation>Meses después, suelte unas fotos nuevas a este lado: comprueban la cámara y no cambian nada.</translation>
    </message>
    <message>
        <source>{0} of {1}</source>
        <translation>{0} de {1}</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>Siguiente</translation>
    </message>
    <message>
        <source>Done</source>
        <translation>Hecho</translation>
    </message>
</context>
<context>
    <name>UncertaintyPanel</name>
    <message>
        <source>Uncertainty</source>
        <translation>Incertidumbre</translation>
    </message>
    <message>
        <source>How well it is known where points are imaged.</source>
        <translation>Con qué certeza se sabe dónde caen los puntos.</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>far away</source>
        <translation>muy lejos</translation>
    </message>
    <message>
        <source>Of the points that the camera will look at; 0 for points far away.</source>
        <translation>De los puntos que mirará la cámara; 0 para puntos muy lejanos.</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>The uncertainty that you can live with: the red line goes around it.</source>
        <translation>La incertidumbre con la que puede vivir: la línea roja la rodea.</translation>
    </message>
    <message>
        <source>P&amp;oints</source>
        <translation>P&amp;untos</translation>
    </message>
    <message>
        <source>Limi&amp;t</source>
        <translation>Lími&amp;te</translation>
    </message>
    <message>
        <source>one σ, worst direction [px]</source>
        <translation>un σ, peor dirección [px]</translation>
    </message>
    <message>
        <source>A point of the scene is imaged this far from where the calibration says (1σ).
What turning and shifting the camera would undo is taken out.
It is what the calibration says of itself. The verdict&apos;s error may be another:
where the remedy of a finding was tried, it is measured against the camera that
the remedy gives. Where there are no corners it adds how far another lens model
goes apart from this one that fits as well.</source>
        <translation>Un punto de la escena se forma a esta distancia de donde dice la calibración (1σ).
Se quita lo que anularía girar y desplazar la cámara.
Es lo que la calibración dice de sí misma. El error del veredicto puede ser otro:
donde se probó el remedio de un hallazgo, se mide contra la cámara que da
el remedio. Donde no hay esquinas suma cuánto se aparta otro modelo de lente
que encaja igual de bien.</translation>
    </message>
    <message>
        <source>Working…</source>
        <translation>Calculando…</translation>
    </message>
    <message>
        <source>Propagating the uncertainty</source>
        <translation>Propagando la incertidumbre</translation>
    </message>
    <message>
        <source> (inside the red line)</source>
        <translation> (dentro de la línea roja)</translation>
    </message>
    <message>
        <source>By this lens model points {0} are imaged to {1} px at the centre, {2} px in the median, {3} px at worst (1σ). {4:.0f} % of the image is known to {5:g} px or better{6}.</source>
        <translation>Con este modelo de lente los puntos {0} se forman a {1} px en el centro, {2} px en la mediana, {3} px en el peor caso (1σ). El {4:.0f} % de la imagen se conoce a {5:g} px o mejor{6}.</translation>
    </message>
    <message>
        <source>{0:g} mm away</source>
        <translation>a {0:g} mm</translation>
    </message>
    <message>
        <source> The brightest colour is {0} px or more.</source>
        <translation> El color más claro es {0} px o más.</translation>
    </message>
    <message>
        <source>Point at the map to read it.</source>
        <translation>Señale el mapa para leerlo.</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, in all directions {3:.3f} px</source>
        <translation>u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, en todas direcciones {3:.3f} px</translation>
    </message>
</context>
<context>
    <name>UndistortPanel</name>
    <message>
        <source>Undistort</source>
        <translation>Corregir</translation>
    </message>
    <message>
        <source>An image without the lens&apos;s distortion, or rectified to the board.</source>
        <translation>Una imagen sin la distorsión de la lente, o rectificada al tablero.</translation>
    </message>
    <message>
        <source>Angle from the left edge of the new image to the right one</source>
        <translation>Ángulo del borde izquierdo de la nueva imagen al derecho</translation>
    </message>
    <message>
        <source>Field of view in degrees</source>
        <translation>Campo de visión en grados</translation>
    </message>
    <message>
        <source>Save &amp;this…</source>
        <translation>Guardar &amp;esta…</translation>
    </message>
    <message>
        <source>&amp;Save all…</source>
        <translation>Guardar &amp;todas…</translation>
    </message>
    <message>
        <source>Write the selected image as it is shown here into a folder</source>
        <translation>Escribir la imagen elegida, como se ve aquí, en una carpeta</translation>
    </message>
    <message>
        <source>Write all images like this into a folder, those that were left out as well</source>
        <translation>Escribir así todas las imágenes en una carpeta, también las omitidas</translation>
    </message>
    <message>
        <source>as taken</source>
        <translation>como se tomó</translation>
    </message>
    <message>
        <source>undistorted</source>
        <translation>corregida</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>Perspectiva</translation>
    </message>
    <message>
        <source>Cylindrical</source>
        <translation>Cilíndrica</translation>
    </message>
    <message>
        <source>Equirectangular</source>
        <translation>Equirrectangular</translation>
    </message>
    <message>
        <source>Stereographic</source>
        <translation>Estereográfica</translation>
    </message>
    <message>
        <source>Cube</source>
        <translation>Cubo</translation>
    </message>
    <message>
        <source>Rectified to the board</source>
        <translation>Rectificada al tablero</translation>
    </message>
    <message>
        <source>Perspective keeps straight lines straight, and shows less than 180°.
Cylindrical unrolls the horizon; upright lines stay straight.
Equirectangular is a map of longitude and latitude, for viewers of 360° images.
Stereographic is a wide view in which small things keep their shape.
Cube makes perspective images of 90° to all sides.
Rectified shows the board from straight above.</source>
        <translation>Perspectiva mantiene rectas las rectas y muestra menos de 180°.
Cilíndrica desenrolla el horizonte; las verticales siguen rectas.
Equirrectangular es un mapa de longitud y latitud, para visores de 360°.
Estereográfica es una vista amplia en que lo pequeño conserva su forma.
Cubo hace imágenes en perspectiva de 90° a todos los lados.
Rectificada muestra el tablero desde justo encima.</translation>
    </message>
    <message>
        <source>What to make of the image</source>
        <translation>Qué hacer de la imagen</translation>
    </message>
    <message>
        <source>All pixels</source>
        <translation>Todos los píxeles</translation>
    </message>
    <message>
        <source>No black border</source>
        <translation>Sin borde negro</translation>
    </message>
    <message>
        <source>Same scale</source>
        <translation>Misma escala</translation>
    </message>
    <message>
        <source>Field of view</source>
        <translation>Campo de visión</translation>
    </message>
    <message>
        <source>All pixels keeps everything, with black beyond it; no black border cuts to a full rectangle;
same scale keeps the size of the middle; field of view shows an angle of your choice.</source>
        <translation>Todos los píxeles conserva todo, con negro alrededor; sin borde negro recorta a un rectángulo lleno;
misma escala conserva el tamaño del centro; campo de visión muestra el ángulo que elija.</translation>
    </message>
    <message>
        <source>How much of the image to show</source>
        <translation>Cuánto de la imagen mostrar</translation>
    </message>
    <message>
        <source>{0}: working…</source>
        <translation>{0}: calculando…</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>Corrigiendo {0}</translation>
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
        <translation>Remedio</translation>
    </message>
    <message>
        <source>Judging the calibration</source>
        <translation>Juzgando la calibración</translation>
    </message>
    <message>
        <source>SEARCHING CORNERS…</source>
        <translation>BUSCANDO ESQUINAS…</translation>
    </message>
    <message>
        <source>CALIBRATING…</source>
        <translation>CALIBRANDO…</translation>
    </message>
    <message>
        <source>NOT CALIBRATED</source>
        <translation>SIN CALIBRAR</translation>
    </message>
    <message>
        <source>KNOWN CAMERA</source>
        <translation>CÁMARA CONOCIDA</translation>
    </message>
    <message>
        <source>FIRST FIT</source>
        <translation>PRIMER AJUSTE</translation>
    </message>
    <message>
        <source>JUDGING…</source>
        <translation>JUZGANDO…</translation>
    </message>
    <message>
        <source>Of {0} photographs. {1}</source>
        <translation>De {0} fotos. {1}</translation>
    </message>
    <message>
        <source>The new calibration is being made better, and judged.</source>
        <translation>La nueva calibración se mejora y se juzga.</translation>
    </message>
    <message>
        <source>The new calibration is being judged: what makes it better is tried.</source>
        <translation>Se juzga la nueva calibración: se prueba lo que la mejora.</translation>
    </message>
    <message>
        <source>No photograph can be used: click one to see why.</source>
        <translation>Ninguna foto se puede usar: pulse una para ver por qué.</translation>
    </message>
    <message>
        <source>No board of the kind “{0}” was found: click a photograph to see why.</source>
        <translation>No se halló ningún tablero de la clase «{0}»: pulse una foto para ver por qué.</translation>
    </message>
    <message>
        <source>Mark the board in the photographs (M), or let them be searched: Set-up.</source>
        <translation>Marque el tablero en las fotos (M), o deje que se busque: Ajustes.</translation>
    </message>
    <message>
        <source>How far the camera can be trusted is said here once it is calibrated.</source>
        <translation>Cuánto se puede confiar en la cámara se dice aquí una vez calibrada.</translation>
    </message>
    <message>
        <source>&amp;1 finding</source>
        <translation>&amp;1 hallazgo</translation>
    </message>
    <message>
        <source>{0} &amp;findings</source>
        <translation>{0} &amp;hallazgos</translation>
    </message>
    <message>
        <source>List what is wrong, with the figures that show it</source>
        <translation>Listar lo que falla, con las cifras que lo muestran</translation>
    </message>
    <message>
        <source>Is it &amp;glass?</source>
        <translation>¿Es &amp;vidrio?</translation>
    </message>
    <message>
        <source>Say what it brings to state that the board is of glass</source>
        <translation>Decir qué aporta indicar que el tablero es de vidrio</translation>
    </message>
    <message>
        <source>State a board of glass</source>
        <translation>Indicar un tablero de vidrio</translation>
    </message>
</context>
<context>
    <name>VerdictTexts</name>
    <message>
        <source>GOOD</source>
        <translation>BUENA</translation>
    </message>
    <message>
        <source>USABLE</source>
        <translation>UTILIZABLE</translation>
    </message>
    <message>
        <source>CAN BE {0}× BETTER</source>
        <translation>MEJORABLE {0}×</translation>
    </message>
    <message>
        <source>NOT USABLE</source>
        <translation>NO UTILIZABLE</translation>
    </message>
    <message>
        <source>Error: unknown</source>
        <translation>Error: desconocido</translation>
    </message>
    <message>
        <source>Error: centre {0}, among corners {1}, edge {2}, worst {3} px</source>
        <translation>Error: centro {0}, entre esquinas {1}, borde {2}, peor {3} px</translation>
    </message>
    <message>
        <source>{0} mm at the edge, {1:.0f} mm away</source>
        <translation>{0} mm en el borde, a {1:.0f} mm</translation>
    </message>
    <message>
        <source>edge: {0} mm at {1} m</source>
        <translation>borde: {0} mm a {1} m</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} circles</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px de {2:,} círculos</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} corners</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px de {2:,} esquinas</translation>
    </message>
    <message>
        <source>Estimate the board&apos;s shape</source>
        <translation>Estimar la forma del tablero</translation>
    </message>
    <message>
        <source>Take the lens model that fits</source>
        <translation>Tomar el modelo apto</translation>
    </message>
    <message>
        <source>Leave these corners out</source>
        <translation>Omitir estas esquinas</translation>
    </message>
    <message>
        <source>Leave {0} out</source>
        <translation>Omitir {0}</translation>
    </message>
    <message>
        <source>Free {0}</source>
        <translation>Liberar {0}</translation>
    </message>
    <message>
        <source>Hold {0} at 0</source>
        <translation>Fijar {0} en 0</translation>
    </message>
    <message>
        <source>Estimate the skew</source>
        <translation>Estimar la oblicuidad</translation>
    </message>
    <message>
        <source>Weigh views by their noise</source>
        <translation>Ponderar por el ruido</translation>
    </message>
    <message>
        <source>Look at {0}</source>
        <translation>Mirar {0}</translation>
    </message>
    <message>
        <source>Show where to hold the board</source>
        <translation>Mostrar dónde va el tablero</translation>
    </message>
</context>
<context>
    <name>Videos</name>
    <message>
        <source>Decoding {0}</source>
        <translation>Decodificando {0}</translation>
    </message>
    <message>
        <source>Finding corners</source>
        <translation>Buscando esquinas</translation>
    </message>
</context>
<context>
    <name>Welcome</name>
    <message>
        <source>Calibrate a camera</source>
        <translation>Calibrar una cámara</translation>
    </message>
    <message>
        <source>Drop photographs of a flat board here, or a saved project. The board&apos;s kind and size are found.</source>
        <translation>Suelte aquí fotos de un tablero plano, o un proyecto guardado. La clase y el tamaño del tablero se averiguan.</translation>
    </message>
    <message>
        <source>Open a f&amp;older of images</source>
        <translation>Abrir una &amp;carpeta de imágenes</translation>
    </message>
    <message>
        <source>Corners are found and the camera is calibrated at once.</source>
        <translation>Se hallan las esquinas y la cámara se calibra enseguida.</translation>
    </message>
    <message>
        <source>&amp;Photograph live</source>
        <translation>&amp;Fotografiar en vivo</translation>
    </message>
    <message>
        <source>The camera&apos;s image shows where to hold the board.</source>
        <translation>La imagen de la cámara muestra dónde poner el tablero.</translation>
    </message>
    <message>
        <source>&amp;Add images</source>
        <translation>&amp;Añadir imágenes</translation>
    </message>
    <message>
        <source>Choose single files.</source>
        <translation>Elegir archivos sueltos.</translation>
    </message>
    <message>
        <source>Open the &amp;sample</source>
        <translation>Abrir la &amp;muestra</translation>
    </message>
    <message>
        <source>Fourteen rendered photographs, to look around.</source>
        <translation>Catorce fotos sintéticas, para mirar alrededor.</translation>
    </message>
    <message>
        <source>Take the to&amp;ur</source>
        <translation>Reco&amp;rrido</translation>
    </message>
    <message>
        <source>Prin&amp;t a board</source>
        <translation>Im&amp;primir un tablero</translation>
    </message>
    <message>
        <source>Two minutes on the sample; it can be left at any step.</source>
        <translation>Dos minutos con la muestra; se puede dejar en cualquier paso.</translation>
    </message>
    <message>
        <source>A checkerboard, or one of the other kinds, in true size.</source>
        <translation>Un ajedrezado u otra clase, a tamaño real.</translation>
    </message>
    <message>
        <source>Recent projects and folders</source>
        <translation>Proyectos y carpetas recientes</translation>
    </message>
</context>
<context>
    <name>WorldReading</name>
    <message>
        <source>ray {0:.2f}° {1}, {2:.2f}° {3}</source>
        <translation>rayo {0:.2f}° {1}, {2:.2f}° {3}</translation>
    </message>
    <message>
        <source>left</source>
        <translation>izquierda</translation>
    </message>
    <message>
        <source>right</source>
        <translation>derecha</translation>
    </message>
    <message>
        <source>up</source>
        <translation>arriba</translation>
    </message>
    <message>
        <source>down</source>
        <translation>abajo</translation>
    </message>
    <message>
        <source>   board X {0:.2f}, Y {1:.2f} mm</source>
        <translation>   tablero X {0:.2f}, Y {1:.2f} mm</translation>
    </message>
</context>
<context>
    <name>actions</name>
    <message>
        <source>Close</source>
        <translation>Cerrar</translation>
    </message>
</context>
<context>
    <name>files</name>
    <message>
        <source>Replace a file</source>
        <translation>Sustituir un archivo</translation>
    </message>
    <message>
        <source>{0} exists. Replace it?</source>
        <translation>{0} ya existe. ¿Sustituirlo?</translation>
    </message>
</context>
<context>
    <name>glossary</name>
    <message>
        <source>Focal length along the image&apos;s rows, in widths of a pixel.</source>
        <translation>Distancia focal a lo largo de las filas de la imagen, en anchos de un píxel.</translation>
    </message>
    <message>
        <source>Focal length along the image&apos;s columns, in heights of a pixel.</source>
        <translation>Distancia focal a lo largo de las columnas de la imagen, en altos de un píxel.</translation>
    </message>
    <message>
        <source>Column of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>Columna del punto principal, donde lo corta el eje de la lente, px.</translation>
    </message>
    <message>
        <source>Row of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>Fila del punto principal, donde lo corta el eje de la lente, px.</translation>
    </message>
    <message>
        <source>Lean of the pixel&apos;s columns, px; 0 for every sensor of today.</source>
        <translation>Inclinación de las columnas de píxeles, px; 0 en todo sensor de hoy.</translation>
    </message>
    <message>
        <source>First coefficient of the radial distortion, of the lowest power.</source>
        <translation>Primer coeficiente de la distorsión radial, de la menor potencia.</translation>
    </message>
    <message>
        <source>Second coefficient of the radial distortion.</source>
        <translation>Segundo coeficiente de la distorsión radial.</translation>
    </message>
    <message>
        <source>Third coefficient of the radial distortion.</source>
        <translation>Tercer coeficiente de la distorsión radial.</translation>
    </message>
    <message>
        <source>Decentering distortion, of a lens whose elements are out of line.</source>
        <translation>Distorsión de descentrado, de una lente con elementos no alineados.</translation>
    </message>
    <message>
        <source>Growth of the decentering distortion with the radius squared.</source>
        <translation>Aumento de la distorsión de descentrado con el cuadrado del radio.</translation>
    </message>
    <message>
        <source>The value with its standard deviation: two times in three it is so far off or less.</source>
        <translation>El valor con su desviación estándar: dos de cada tres veces se aparta eso o menos.</translation>
    </message>
    <message>
        <source>Standard deviation: two times in three a value is so far off or less.</source>
        <translation>Desviación estándar: dos de cada tres veces un valor se aparta eso o menos.</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>en σ</translation>
    </message>
    <message>
        <source>A difference in standard deviations: more than 3 is hardly chance.</source>
        <translation>Una diferencia en desviaciones estándar: más de 3 es difícilmente casual.</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>DE de la tabla 2</translation>
    </message>
    <message>
        <source>The standard deviation as the paper computes it, which leaves the size of the residuals out.</source>
        <translation>La desviación estándar como la calcula el artículo, sin el tamaño de los residuos.</translation>
    </message>
    <message>
        <source>Root mean square: the typical length of the residuals, in which large ones count most.</source>
        <translation>Media cuadrática: la longitud típica de los residuos, en la que los grandes cuentan más.</translation>
    </message>
    <message>
        <source>residual</source>
        <translation>residuo</translation>
    </message>
    <message>
        <source>What a corner was measured at, less where camera and board put it.</source>
        <translation>Donde se midió una esquina, menos donde la ponen cámara y tablero.</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s rows: measured less predicted column.</source>
        <translation>Residuo a lo largo de las filas de la imagen: columna medida menos predicha.</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s columns: measured less predicted row.</source>
        <translation>Residuo a lo largo de las columnas de la imagen: fila medida menos predicha.</translation>
    </message>
    <message>
        <source>Length of a residual in the image.</source>
        <translation>Longitud de un residuo en la imagen.</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>px de referencia</translation>
    </message>
    <message>
        <source>The paper&apos;s unit on the board: a square has 30 of them, whatever its size in the image.</source>
        <translation>La unidad del artículo en el tablero: un cuadro tiene 30, sea cual sea su tamaño en la imagen.</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s rows, on the paper&apos;s reference plane.</source>
        <translation>Residuo a lo largo de las filas del tablero, en el plano de referencia del artículo.</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s columns, on the paper&apos;s reference plane.</source>
        <translation>Residuo a lo largo de las columnas del tablero, en el plano de referencia del artículo.</translation>
    </message>
    <message>
        <source>Length of a residual on the paper&apos;s reference plane, where a square has 30 px.</source>
        <translation>Longitud de un residuo en el plano de referencia del artículo, donde un cuadro tiene 30 px.</translation>
    </message>
    <message>
        <source>aspect ratio</source>
        <translation>relación de aspecto</translation>
    </message>
    <message>
        <source>Width of a pixel over its height, fy over fx; 1 for square pixels.</source>
        <translation>Ancho de un píxel entre su alto, fy entre fx; 1 con píxeles cuadrados.</translation>
    </message>
    <message>
        <source>The paper&apos;s equation of cosines: where it is 0, r is the aspect ratio that one view gives by itself.</source>
        <translation>La ecuación de los cosenos del artículo: donde es 0, r es la relación de aspecto que da una vista por sí sola.</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>coste c</translation>
    </message>
    <message>
        <source>The mean squared residual that the calibration makes as small as it can.</source>
        <translation>El residuo cuadrático medio que la calibración hace tan pequeño como puede.</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>iteración</translation>
    </message>
    <message>
        <source>One improvement of all parameters together.</source>
        <translation>Una mejora de todos los parámetros juntos.</translation>
    </message>
    <message>
        <source>density</source>
        <translation>densidad</translation>
    </message>
    <message>
        <source>Share of the residuals for each px of their length, so that all bars have area 1.</source>
        <translation>Proporción de los residuos por px de su longitud, de modo que todas las barras suman área 1.</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>distancia</translation>
    </message>
    <message>
        <source>Distance from the camera to the middle of the board.</source>
        <translation>Distancia de la cámara al centro del tablero.</translation>
    </message>
    <message>
        <source>tilt</source>
        <translation>inclinación</translation>
    </message>
    <message>
        <source>Angle between the board and the image plane; 0 if the camera looks straight at it.</source>
        <translation>Ángulo entre el tablero y el plano de la imagen; 0 si la cámara lo mira de frente.</translation>
    </message>
    <message>
        <source>displacement d</source>
        <translation>desplazamiento d</translation>
    </message>
    <message>
        <source>How far the lens moves the image of a point from where a pinhole would put it.</source>
        <translation>Cuánto mueve la lente la imagen de un punto de donde la pondría un estenopo.</translation>
    </message>
    <message>
        <source>one σ, worst direction</source>
        <translation>un σ, peor dirección</translation>
    </message>
    <message>
        <source>How uncertain the image of a point is along the direction in which that is worst.</source>
        <translation>Cuán incierta es la imagen de un punto en la dirección en que peor se conoce.</translation>
    </message>
    <message>
        <source>correlated errors</source>
        <translation>errores correlacionados</translation>
    </message>
    <message>
        <source>Errors of neighbouring corners that point the same way, so that many corners tell less than their number.</source>
        <translation>Errores de esquinas vecinas que apuntan igual, de modo que muchas dicen menos que su número.</translation>
    </message>
    <message>
        <source>share errors</source>
        <translation>comparten errores</translation>
    </message>
    <message>
        <source>Of corners: neighbours are off alike, so that many tell less than their number.</source>
        <translation>De esquinas: las vecinas se desvían igual, de modo que muchas dicen menos que su número.</translation>
    </message>
    <message>
        <source>unseen views</source>
        <translation>vistas no vistas</translation>
    </message>
    <message>
        <source>Views that were left out of a calibration, to see how well it predicts them.</source>
        <translation>Vistas que se omitieron en una calibración, para ver cómo las predice.</translation>
    </message>
    <message>
        <source>Bayesian information criterion: misfit plus a price for each parameter; the least is best.</source>
        <translation>Criterio de información bayesiano: desajuste más un precio por parámetro; el menor es el mejor.</translation>
    </message>
    <message>
        <source>Column of a pixel: 0 at the middle of the leftmost one.</source>
        <translation>Columna de un píxel: 0 en el centro del primero por la izquierda.</translation>
    </message>
    <message>
        <source>Row of a pixel: 0 at the middle of the topmost one, growing downwards.</source>
        <translation>Fila de un píxel: 0 en el centro del primero por arriba, creciendo hacia abajo.</translation>
    </message>
</context>
<context>
    <name>lengths</name>
    <message>
        <source> if circles are {0:g} mm apart</source>
        <translation> si los círculos distan {0:g} mm</translation>
    </message>
    <message>
        <source> if tags are {0:g} mm</source>
        <translation> si las etiquetas miden {0:g} mm</translation>
    </message>
    <message>
        <source> if squares are {0:g} mm</source>
        <translation> si los cuadros miden {0:g} mm</translation>
    </message>
    <message>
        <source>Lengths hold{0}.</source>
        <translation>Las longitudes valen{0}.</translation>
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
        <translation>Método</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Ajuste</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>Lente</translation>
    </message>
    <message>
        <source>Board</source>
        <translation>Tablero</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>3-D</translation>
    </message>
    <message>
        <source>Undistort</source>
        <translation>Corregir</translation>
    </message>
    <message>
        <source>Compare</source>
        <translation>Comparar</translation>
    </message>
    <message>
        <source>The photographs, and what was found in them.</source>
        <translation>Las fotos, y lo que se halló en ellas.</translation>
    </message>
    <message>
        <source>How the camera was found, step by step as in the paper.</source>
        <translation>Cómo se halló la cámara, paso a paso como en el artículo.</translation>
    </message>
    <message>
        <source>How well the photographs agree, and every value.</source>
        <translation>Cómo concuerdan las fotos, y cada valor.</translation>
    </message>
    <message>
        <source>What the lens does, and which model describes it.</source>
        <translation>Qué hace la lente, y qué modelo la describe.</translation>
    </message>
    <message>
        <source>How the real board differs from the drawing.</source>
        <translation>En qué difiere el tablero real del dibujo.</translation>
    </message>
    <message>
        <source>Where the board was held, and where to hold it next.</source>
        <translation>Dónde se sostuvo el tablero, y dónde ponerlo ahora.</translation>
    </message>
    <message>
        <source>Photographs without the distortion of the lens.</source>
        <translation>Fotos sin la distorsión de la lente.</translation>
    </message>
    <message>
        <source>Two results side by side.</source>
        <translation>Dos resultados lado a lado.</translation>
    </message>
</context>
<context>
    <name>plots</name>
    <message>
        <source>Copy as image</source>
        <translation>Copiar como imagen</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>Guardar gráfico…</translation>
    </message>
    <message>
        <source>Save plot</source>
        <translation>Guardar gráfico</translation>
    </message>
    <message>
        <source>PNG image (*.png);;SVG drawing (*.svg)</source>
        <translation>Imagen PNG (*.png);;Dibujo SVG (*.svg)</translation>
    </message>
</context>
<context>
    <name>questions</name>
    <message>
        <source>&amp;Yes</source>
        <translation>&amp;Sí</translation>
    </message>
    <message>
        <source>&amp;No</source>
        <translation>&amp;No</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>&amp;Guardar</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>Guardar &amp;como…</translation>
    </message>
    <message>
        <source>&amp;Discard</source>
        <translation>&amp;Descartar</translation>
    </message>
    <message>
        <source>&amp;Cancel</source>
        <translation>&amp;Cancelar</translation>
    </message>
</context>
<context>
    <name>status_text</name>
    <message>
        <source>not searched</source>
        <translation>sin buscar</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>sin tablero</translation>
    </message>
    <message>
        <source>unreadable</source>
        <translation>ilegible</translation>
    </message>
    <message>
        <source>wrong size</source>
        <translation>otro tamaño</translation>
    </message>
    <message>
        <source>found</source>
        <translation>hallado</translation>
    </message>
    <message>
        <source>{0} of {1}, ambiguous</source>
        <translation>{0} de {1}, ambiguo</translation>
    </message>
    <message>
        <source>{0} of {1} corners</source>
        <translation>{0} de {1} esquinas</translation>
    </message>
    <message>
        <source>{0} corners</source>
        <translation>{0} esquinas</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>omitida</translation>
    </message>
</context>
<context>
    <name>status_tip</name>
    <message>
        <source>Which part of the board is seen cannot be decided from it.</source>
        <translation>No se puede decidir por ella qué parte del tablero se ve.</translation>
    </message>
    <message>
        <source>A turn of the board by {0} cannot be seen in its pattern.</source>
        <translation>Un giro del tablero de {0} no se ve en su patrón.</translation>
    </message>
    <message>
        <source>Another board is seen here, of {0} × {1} inner corners.</source>
        <translation>Aquí se ve otro tablero, de {0} × {1} esquinas interiores.</translation>
    </message>
</context>
</TS>
