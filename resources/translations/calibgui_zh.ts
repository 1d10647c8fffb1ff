<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="zh_CN">
<context>
    <name>Banner</name>
    <message>
        <source>Dismiss this message</source>
        <translation>关闭此消息</translation>
    </message>
</context>
<context>
    <name>BeforeAndAfter</name>
    <message>
        <source>Error of a pixel before and after</source>
        <translation>之前和之后的像素误差</translation>
    </message>
    <message>
        <source>Parameters before and after</source>
        <translation>之前和之后的参数</translation>
    </message>
    <message>
        <source>Distance between a point&apos;s images before and after, after the rotation that
brings the two closest where corners (dots) were seen.</source>
        <translation>同一点在之前和之后成像的距离，已去除使两者
在见到角点（小点）之处最接近的旋转。</translation>
    </message>
    <message>
        <source>&amp;Keep</source>
        <translation>保留(&amp;K)</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>撤回(&amp;T)</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is {1} times smaller</source>
        <translation>{0}：有角点处的误差减小到 1/{1}</translation>
    </message>
    <message>
        <source>{0}: the error where there are corners is not smaller</source>
        <translation>{0}：有角点处的误差没有减小</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>之前</translation>
    </message>
    <message>
        <source>After</source>
        <translation>之后</translation>
    </message>
    <message>
        <source>Change</source>
        <translation>变化</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.</source>
        <translation>除以独立估计之差的标准差。</translation>
    </message>
    <message>
        <source>The difference is being computed.</source>
        <translation>正在计算差异。</translation>
    </message>
    <message>
        <source>Error, {0} [px]</source>
        <translation>误差，{0} [px]</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>中心</translation>
    </message>
    <message>
        <source>among corners</source>
        <translation>角点之间</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>边缘</translation>
    </message>
    <message>
        <source>worst</source>
        <translation>最差</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>结论</translation>
    </message>
</context>
<context>
    <name>BoardList</name>
    <message>
        <source>Boards</source>
        <translation>标定板</translation>
    </message>
    <message>
        <source>Add a &amp;board</source>
        <translation>添加标定板(&amp;B)</translation>
    </message>
    <message>
        <source>Re&amp;move</source>
        <translation>移除(&amp;M)</translation>
    </message>
    <message>
        <source>A further board that stands fast to the first and is told from it by its markers or tags</source>
        <translation>与第一块固定在一起、靠标记或标签与之区分的另一块标定板</translation>
    </message>
    <message>
        <source>As the photo&amp;graphs show it</source>
        <translation>以照片所示为准(&amp;G)</translation>
    </message>
    <message>
        <source>Take the board that the photographs show; turn it off to state it.</source>
        <translation>采用照片中显示的标定板;关闭后可自行填写。</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation type="unfinished">未填写</translation>
    </message>
    <message>
        <source> mm</source>
        <translation type="unfinished"> mm</translation>
    </message>
    <message>
        <source>taken as {0} mm</source>
        <translation>按 {0} mm 计</translation>
    </message>
    <message>
        <source>Not measured if 0: all lengths then hold for squares so long</source>
        <translation>0 表示未测量:此时所有长度按该方格边长计算</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation type="unfinished">方格边长</translation>
    </message>
    <message>
        <source>Stands where I &amp;know</source>
        <translation>位置已知(&amp;K)</translation>
    </message>
    <message>
        <source>State where the board stands beside the first one; turn it off to have that estimated with the rig.</source>
        <translation>填写该板相对第一块的位置;关闭则随相机组一起估计。</translation>
    </message>
    <message>
        <source>{0}, mm</source>
        <translation>{0},mm</translation>
    </message>
    <message>
        <source>rotation vector, {0}, degrees</source>
        <translation>旋转向量 {0},度</translation>
    </message>
    <message>
        <source>Beside board 1, in mm and degrees:</source>
        <translation>相对于标定板 1（毫米和度）：</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>标定板 {0}</translation>
    </message>
</context>
<context>
    <name>BoardPanel</name>
    <message>
        <source>&amp;Counted in the images</source>
        <translation>从图像中计数(&amp;C)</translation>
    </message>
    <message>
        <source>Take the size that most images show; turn it off to state it.</source>
        <translation>采用多数图像显示的大小；关闭后可自行指定。</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>内角点行数</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>内角点列数</translation>
    </message>
    <message>
        <source>Corners where four squares meet: one fewer than squares each way.</source>
        <translation>四个方格相交的角点：每个方向比方格数少一。</translation>
    </message>
    <message>
        <source>Side of one square. Only the distances depend on it: measure several squares together and divide.</source>
        <translation>一个方格的边长。只有距离取决于它：请一起量多个方格再相除。</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>方格边长</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>精确</translation>
    </message>
    <message>
        <source>One standard deviation of the side, which all squares share: every length is uncertain by the same share. A certificate&apos;s U (k = 2) is twice as much.</source>
        <translation>边长的一个标准差，所有方格相同：每个长度都按同样比例不确定。证书的 U (k = 2) 是它的两倍。</translation>
    </message>
    <message>
        <source>Standard deviation of the side of a square</source>
        <translation>方格边长的标准差</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>by their edges</source>
        <translation>按边缘</translation>
    </message>
    <message>
        <source>Fit the edges that cross at each corner, as exactly as the noise allows, and tell how exact that is.</source>
        <translation>拟合在每个角点相交的边缘，达到噪声允许的精度，并给出精度。</translation>
    </message>
    <message>
        <source>by the saddle point</source>
        <translation>按鞍点</translation>
    </message>
    <message>
        <source>As the paper does: the saddle point of the grey levels at each corner.</source>
        <translation>如论文所做：每个角点处灰度的鞍点。</translation>
    </message>
    <message>
        <source>How corners are located; another way searches anew.</source>
        <translation>角点如何定位；换一种方式会重新搜索。</translation>
    </message>
    <message>
        <source>all rows</source>
        <translation>所有行</translation>
    </message>
    <message>
        <source>odd rows</source>
        <translation>奇数行</translation>
    </message>
    <message>
        <source>even rows</source>
        <translation>偶数行</translation>
    </message>
    <message>
        <source>Search one field of interlaced frames, in which edges that moved between the two are not combed. The rows between are interpolated.</source>
        <translation>搜索隔行图像的一场，其中移动的边缘不会出现梳状。中间的行用插值补出。</translation>
    </message>
    <message>
        <source>Mar&amp;k all by hand</source>
        <translation>全部手动标记(&amp;K)</translation>
    </message>
    <message>
        <source>Images are not searched: point at each board&apos;s four outermost corners (M), and Enter goes on to the next image.</source>
        <translation>不搜索图像：指出每块标定板最外侧的四个角点 (M)，回车转到下一幅图像。</translation>
    </message>
    <message>
        <source>read from the images</source>
        <translation>从图像读取</translation>
    </message>
    <message>
        <source>Loca&amp;ted</source>
        <translation>定位(&amp;T)</translation>
    </message>
    <message>
        <source>Interlaced</source>
        <translation>隔行</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>标定板上印的图案。</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>角点数</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>图案</translation>
    </message>
    <message>
        <source>Way to locate corners</source>
        <translation>角点定位方式</translation>
    </message>
    <message>
        <source>Rows of interlaced frames</source>
        <translation>隔行图像的行</translation>
    </message>
    <message>
        <source>Mark by hand</source>
        <translation>手动标记</translation>
    </message>
    <message>
        <source>Search the images</source>
        <translation>搜索图像</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>方格大小</translation>
    </message>
    <message>
        <source>Uncertainty of squares</source>
        <translation>方格的不确定度</translation>
    </message>
    <message>
        <source>Unit of squares</source>
        <translation>方格的单位</translation>
    </message>
</context>
<context>
    <name>BoardScreen</name>
    <message>
        <source>Board on the screen</source>
        <translation>屏幕上的标定板</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>Length of the line</source>
        <translation>线的长度</translation>
    </message>
    <message>
        <source>&amp;Close (Esc)</source>
        <translation>关闭 (Esc)(&amp;C)</translation>
    </message>
    <message>
        <source>Measure the line above with a ruler:</source>
        <translation>用尺子量上面的线：</translation>
    </message>
    <message>
        <source>A square is {0} pixels: {1} mm. State this length.</source>
        <translation>一个方格为 {0} 像素：{1} mm。请填写此长度。</translation>
    </message>
    <message>
        <source>Circles are {0} pixels apart: {1} mm. State this length.</source>
        <translation>圆的间距为 {0} 像素：{1} mm。请填写此长度。</translation>
    </message>
</context>
<context>
    <name>BoardShapeChoice</name>
    <message>
        <source>Shape of the board</source>
        <translation>标定板形状</translation>
    </message>
    <message>
        <source>as drawn</source>
        <translation>按图纸</translation>
    </message>
    <message>
        <source>Flat and printed true (nominal). Its errors become the camera&apos;s.</source>
        <translation>平整且印刷准确 (nominal)。它的误差会成为相机的误差。</translation>
    </message>
    <message>
        <source>stretched or askew</source>
        <translation>拉伸或歪斜</translation>
    </message>
    <message>
        <source>Sides of unequal scale, not quite at right angles (affine).</source>
        <translation>两边比例不等，不完全成直角 (affine)。</translation>
    </message>
    <message>
        <source>bowed</source>
        <translation>弯曲</translation>
    </message>
    <message>
        <source>Bent along rows and columns (bow).</source>
        <translation>沿行和列弯曲 (bow)。</translation>
    </message>
    <message>
        <source>free: every corner</source>
        <translation>自由：每个角点</translation>
    </message>
    <message>
        <source>Every corner is estimated in three dimensions (free). Needs 6 views, and every corner in 4 of them, or a prior.</source>
        <translation>每个角点在三维中估计 (free)。需要 6 个视图且每个角点出现在其中 4 个，或有先验。</translation>
    </message>
    <message>
        <source>what predicts best</source>
        <translation>预测最好的</translation>
    </message>
    <message>
        <source>Of these, the one that predicts views best that it has not seen. Slow.</source>
        <translation>其中对未见过的视图预测最好的。较慢。</translation>
    </message>
    <message>
        <source>as in a file…</source>
        <translation>按文件…</translation>
    </message>
    <message>
        <source>Hold a shape that was saved before.</source>
        <translation>固定以前保存的形状。</translation>
    </message>
    <message>
        <source>known to</source>
        <translation>已知到</translation>
    </message>
    <message>
        <source> mm in plane</source>
        <translation> mm 面内</translation>
    </message>
    <message>
        <source>Standard deviation of the print in the plane, mm</source>
        <translation>印刷在平面内的标准差，mm</translation>
    </message>
    <message>
        <source> mm off plane</source>
        <translation> mm 面外</translation>
    </message>
    <message>
        <source>Standard deviation out of the plane: flatness, mm</source>
        <translation>平面外的标准差：平整度，mm</translation>
    </message>
    <message>
        <source>State how far corners may be from where they should be: in the plane, and out of it. Every ± counts it, and few views can then carry a free board.</source>
        <translation>指出角点可能偏离应有位置多少：平面内和平面外。每个 ± 都计入它，于是少量视图就能支持自由的标定板。</translation>
    </message>
    <message>
        <source>Boar&amp;d is</source>
        <translation>标定板(&amp;D)</translation>
    </message>
    <message>
        <source>as in a file: {0:.2g} mm off</source>
        <translation>按文件：偏差 {0:.2g} mm</translation>
    </message>
    <message>
        <source>The board&apos;s shape</source>
        <translation>标定板的形状</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>形状 (*.json)</translation>
    </message>
</context>
<context>
    <name>BoardShapePanel</name>
    <message>
        <source>Board shape</source>
        <translation>标定板形状</translation>
    </message>
    <message>
        <source>How the real board deviates from its drawing.</source>
        <translation>实际标定板与图纸的偏差。</translation>
    </message>
    <message>
        <source>&amp;Save shape…</source>
        <translation>保存形状(&amp;S)…</translation>
    </message>
    <message>
        <source>Write the board&apos;s shape to a file, for later calibrations with the same board: Set-up, Board is: as in a file.</source>
        <translation>把标定板的形状写入文件，供以后用同一块板标定：设置，标定板：按文件。</translation>
    </message>
    <message>
        <source>X on the board</source>
        <translation>板上的 X</translation>
    </message>
    <message>
        <source>Y on the board</source>
        <translation>板上的 Y</translation>
    </message>
    <message>
        <source>Arrows: from where corners should be to where they are, magnified.
Colours: out of the plane; red is away from the camera.</source>
        <translation>箭头：从角点应在之处到实际所在，已放大。
颜色：平面外；红色为远离相机。</translation>
    </message>
    <message>
        <source>The board was taken as drawn. To estimate its shape, choose “free” or another model at “Board is” in the Set-up and calibrate again.</source>
        <translation>标定板按图纸处理。要估计其形状，请在设置的“标定板”处选择“自由”或其他模型并重新标定。</translation>
    </message>
    <message>
        <source>out of the plane [{0}]</source>
        <translation>平面外 [{0}]</translation>
    </message>
    <message>
        <source>{0:g} mm in the plane</source>
        <translation>平面内 {0:g} mm</translation>
    </message>
    <message>
        <source> Each is known to ± {0:.2g} mm (1σ, median).</source>
        <translation> 每个已知到 ± {0:.2g} mm（1σ，中位数）。</translation>
    </message>
    <message>
        <source>Point at a corner to read it.</source>
        <translation>指向角点即可读数。</translation>
    </message>
    <message>
        <source>({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm</source>
        <translation>({0:g}, {1:g}) mm：x {2}，y {3}，z {4} mm</translation>
    </message>
    <message>
        <source>Save the board&apos;s shape</source>
        <translation>保存标定板形状</translation>
    </message>
    <message>
        <source>Shapes (*.json)</source>
        <translation>形状 (*.json)</translation>
    </message>
</context>
<context>
    <name>BugDialog</name>
    <message>
        <source>Something went wrong</source>
        <translation>出错了</translation>
    </message>
    <message>
        <source>This is a fault of the program, not of your images. Your work has been kept. Please report the text below; you can go on, or save and start again.</source>
        <translation>这是程序的错误，不是您的图像。您的工作已保存。请报告下面的文字；您可以继续，或保存后重新启动。</translation>
    </message>
    <message>
        <source>What to report</source>
        <translation>要报告的内容</translation>
    </message>
    <message>
        <source>&amp;Copy</source>
        <translation>复制(&amp;C)</translation>
    </message>
</context>
<context>
    <name>Calibrator</name>
    <message>
        <source>Calibrating</source>
        <translation>正在标定</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>正在比较镜头模型</translation>
    </message>
    <message>
        <source>Making the camera better</source>
        <translation>正在改进相机</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>标定</translation>
    </message>
    <message>
        <source>Known camera</source>
        <translation>已知相机</translation>
    </message>
    <message>
        <source>No board is marked yet, and the search is off.</source>
        <translation>还没有标记标定板，而搜索已关闭。</translation>
    </message>
    <message>
        <source>Mark the four outermost corners in at least three photographs (Mark board), or turn “Mark all by hand” off.</source>
        <translation>请在至少三张照片中标记最外侧的四个角点（标记标定板），或关闭“全部手动标记”。</translation>
    </message>
    <message>
        <source>None of the photographs can be read.</source>
        <translation>没有一张照片可以读取。</translation>
    </message>
    <message>
        <source>Click on one to see why, or add others.</source>
        <translation>点击一张查看原因，或添加其他照片。</translation>
    </message>
    <message>
        <source>There is no image to calibrate from.</source>
        <translation>没有可用于标定的图像。</translation>
    </message>
    <message>
        <source>Add photographs of a board.</source>
        <translation>请添加标定板的照片。</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>改进相机</translation>
    </message>
    <message>
        <source>Calibrate</source>
        <translation>标定</translation>
    </message>
    <message>
        <source>Stopped: “{0}” is the best so far, not the optimum.</source>
        <translation>已停止：“{0}”是目前最好的，不是最优解。</translation>
    </message>
</context>
<context>
    <name>CameraValues</name>
    <message>
        <source>Result</source>
        <translation>结果</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>每次标定都以一个名称保存结果</translation>
    </message>
    <message>
        <source>manage</source>
        <translation>管理</translation>
    </message>
    <message>
        <source>Rename, delete or compare results</source>
        <translation>重命名、删除或比较结果</translation>
    </message>
    <message>
        <source>&amp;Compare with</source>
        <translation>比较(&amp;C)</translation>
    </message>
    <message>
        <source>&amp;Rename…</source>
        <translation>重命名(&amp;R)…</translation>
    </message>
    <message>
        <source>&amp;Delete</source>
        <translation>删除(&amp;D)</translation>
    </message>
    <message>
        <source>All values, correlations, the paper&apos;s units ›</source>
        <translation>所有数值、相关系数、论文单位 ›</translation>
    </message>
    <message>
        <source>Show everything that is known of this result</source>
        <translation>显示此结果的全部已知信息</translation>
    </message>
    <message>
        <source>Still good? Check with new photographs ›</source>
        <translation>仍然好用？用新照片检查 ›</translation>
    </message>
    <message>
        <source>Or drop them here: they check the camera, and join no project</source>
        <translation>或拖放到这里：它们检查相机，不加入任何项目</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
</context>
<context>
    <name>Canvas</name>
    <message>
        <source>Photograph</source>
        <translation>照片</translation>
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
        <translation>限值</translation>
    </message>
    <message>
        <source>Change from which the camera counts as changed, px rms</source>
        <translation>相机视为已改变的变化量，px（均方根）</translation>
    </message>
    <message>
        <source>C&amp;heck with others…</source>
        <translation>用其他照片检查(&amp;H)…</translation>
    </message>
    <message>
        <source>&amp;Close</source>
        <translation>关闭(&amp;C)</translation>
    </message>
    <message>
        <source>&amp;Limit</source>
        <translation>限值(&amp;L)</translation>
    </message>
    <message>
        <source>Images ({0})</source>
        <translation>图像 ({0})</translation>
    </message>
    <message>
        <source>New photographs of the board</source>
        <translation>标定板的新照片</translation>
    </message>
    <message>
        <source>Checking the camera</source>
        <translation>正在检查相机</translation>
    </message>
    <message>
        <source>These photographs cannot be used</source>
        <translation>这些照片无法使用</translation>
    </message>
    <message>
        <source>Is the camera still good?</source>
        <translation>相机仍然好用吗？</translation>
    </message>
    <message>
        <source>The photographs are searched for the board. They join no project.</source>
        <translation>正在照片中搜索标定板。它们不加入任何项目。</translation>
    </message>
    <message>
        <source>STILL GOOD</source>
        <translation>仍然好用</translation>
    </message>
    <message>
        <source>CALIBRATE AGAIN</source>
        <translation>请重新标定</translation>
    </message>
    <message>
        <source>TAKE OTHER PHOTOGRAPHS</source>
        <translation>请拍其他照片</translation>
    </message>
    <message>
        <source>{0} of {1} photographs, the stored camera as it is: RMS {2:.3f} px, σ {3:.3f} px of {4:,} corners.</source>
        <translation>{1} 张照片中的 {0} 张，按保存的相机：RMS {2:.3f} px，σ {3:.3f} px，{4:,} 个角点。</translation>
    </message>
</context>
<context>
    <name>Commands</name>
    <message>
        <source>&amp;Images</source>
        <translation>图像(&amp;I)</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>文件(&amp;F)</translation>
    </message>
    <message>
        <source>&amp;New project</source>
        <translation>新建项目(&amp;N)</translation>
    </message>
    <message>
        <source>Begin with nothing</source>
        <translation>从空白开始</translation>
    </message>
    <message>
        <source>&amp;Open project…</source>
        <translation>打开项目(&amp;O)…</translation>
    </message>
    <message>
        <source>Open a saved project</source>
        <translation>打开已保存的项目</translation>
    </message>
    <message>
        <source>Open &amp;recent</source>
        <translation>最近打开(&amp;R)</translation>
    </message>
    <message>
        <source>Open f&amp;leet…</source>
        <translation>打开机群(&amp;L)…</translation>
    </message>
    <message>
        <source>Show the cameras of a ledger that calibgui batch wrote</source>
        <translation>显示 calibgui batch 写出的台账中的相机</translation>
    </message>
    <message>
        <source>Open the sa&amp;mple</source>
        <translation>打开示例(&amp;M)</translation>
    </message>
    <message>
        <source>Rendered photographs, to look around</source>
        <translation>渲染的照片，供浏览</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>保存(&amp;S)</translation>
    </message>
    <message>
        <source>Write the project to its file</source>
        <translation>把项目写入其文件</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>另存为(&amp;A)…</translation>
    </message>
    <message>
        <source>Write the project to another file</source>
        <translation>把项目写入另一个文件</translation>
    </message>
    <message>
        <source>Add &amp;images…</source>
        <translation>添加图像(&amp;I)…</translation>
    </message>
    <message>
        <source>Choose image files</source>
        <translation>选择图像文件</translation>
    </message>
    <message>
        <source>Add a &amp;folder…</source>
        <translation>添加文件夹(&amp;F)…</translation>
    </message>
    <message>
        <source>Take all images of a folder</source>
        <translation>取文件夹中的所有图像</translation>
    </message>
    <message>
        <source>P&amp;hotograph live…</source>
        <translation>实时拍摄(&amp;H)…</translation>
    </message>
    <message>
        <source>Take photographs with a camera that says where to hold the board</source>
        <translation>用相机拍摄，它会说明标定板放在哪里</translation>
    </message>
    <message>
        <source>Several &amp;cameras…</source>
        <translation>多台相机(&amp;C)…</translation>
    </message>
    <message>
        <source>Calibrate cameras that stand fast to each other: a rig</source>
        <translation>标定彼此固定的相机：相机组</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>退出(&amp;Q)</translation>
    </message>
    <message>
        <source>Close the window</source>
        <translation>关闭窗口</translation>
    </message>
    <message>
        <source>Projects and folders that were opened stand here</source>
        <translation>打开过的项目和文件夹在此列出</translation>
    </message>
    <message>
        <source>No project or folder has been opened yet.</source>
        <translation>还没有打开过项目或文件夹。</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>还没有</translation>
    </message>
    <message>
        <source>Open this project or folder</source>
        <translation>打开此项目或文件夹</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>编辑(&amp;E)</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>撤销(&amp;U)</translation>
    </message>
    <message>
        <source>Take the last change back</source>
        <translation>撤回上一次更改</translation>
    </message>
    <message>
        <source>Nothing has been changed since the project was opened.</source>
        <translation>项目打开以来没有更改。</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>重做(&amp;R)</translation>
    </message>
    <message>
        <source>Do what was undone</source>
        <translation>恢复已撤销的操作</translation>
    </message>
    <message>
        <source>Nothing has been undone.</source>
        <translation>没有撤销过操作。</translation>
    </message>
    <message>
        <source>&amp;Paste paths</source>
        <translation>粘贴路径(&amp;P)</translation>
    </message>
    <message>
        <source>Add the files on the clipboard</source>
        <translation>添加剪贴板上的文件</translation>
    </message>
    <message>
        <source>Copy &amp;table</source>
        <translation>复制表格(&amp;T)</translation>
    </message>
    <message>
        <source>Put the table in sight on the clipboard, for a spreadsheet</source>
        <translation>把可见的表格放到剪贴板，供电子表格使用</translation>
    </message>
    <message>
        <source>No table is in sight: choose a panel with one first.</source>
        <translation>没有可见的表格：请先选择有表格的面板。</translation>
    </message>
    <message>
        <source>Copy p&amp;lot as picture</source>
        <translation>把图表复制为图像(&amp;L)</translation>
    </message>
    <message>
        <source>Put a picture of the plot in sight on the clipboard</source>
        <translation>把可见图表的图像放到剪贴板</translation>
    </message>
    <message>
        <source>No plot is in sight: choose a panel with one first.</source>
        <translation>没有可见的图表：请先选择有图表的面板。</translation>
    </message>
    <message>
        <source>Cali&amp;bration</source>
        <translation>标定(&amp;B)</translation>
    </message>
    <message>
        <source>&amp;Calibrate</source>
        <translation>标定(&amp;C)</translation>
    </message>
    <message>
        <source>Do everything that is still to do</source>
        <translation>完成所有未做的工作</translation>
    </message>
    <message>
        <source>There are no images yet: add some first.</source>
        <translation>还没有图像：请先添加。</translation>
    </message>
    <message>
        <source>S&amp;top</source>
        <translation>停止(&amp;T)</translation>
    </message>
    <message>
        <source>End what the progress bar tells of; what is finished stays</source>
        <translation>结束进度条所示的工作；已完成的保留</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>导出(&amp;E)…</translation>
    </message>
    <message>
        <source>Write the camera for OpenCV, ROS, MATLAB or another program</source>
        <translation>为 OpenCV、ROS、MATLAB 或其他程序写出相机</translation>
    </message>
    <message>
        <source>Nothing is calibrated yet: press Calibrate first.</source>
        <translation>还没有标定：请先按“标定”。</translation>
    </message>
    <message>
        <source>&amp;Report…</source>
        <translation>报告(&amp;R)…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page, or a certificate</source>
        <translation>把已知信息写成 PDF 或网页，或证书</translation>
    </message>
    <message>
        <source>Chec&amp;k with new photographs…</source>
        <translation>用新照片检查(&amp;K)…</translation>
    </message>
    <message>
        <source>Whether the camera is still good; the project stays as it is</source>
        <translation>相机是否仍然好用；项目保持不变</translation>
    </message>
    <message>
        <source>&amp;Series of calibrations…</source>
        <translation>标定系列(&amp;S)…</translation>
    </message>
    <message>
        <source>How a camera varies with zoom, focus, temperature or date</source>
        <translation>相机随变焦、对焦、温度或日期的变化</translation>
    </message>
    <message>
        <source>&amp;Hand and eye…</source>
        <translation>手眼标定(&amp;H)…</translation>
    </message>
    <message>
        <source>Where the camera is in a robot&apos;s hand, or beside the robot</source>
        <translation>相机在机器人手上或机器人旁的位置</translation>
    </message>
    <message>
        <source>&amp;Print a board…</source>
        <translation>打印标定板(&amp;P)…</translation>
    </message>
    <message>
        <source>Make a board of any size</source>
        <translation>制作任意大小的标定板</translation>
    </message>
    <message>
        <source>As the &amp;system</source>
        <translation>跟随系统(&amp;S)</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>浅色(&amp;L)</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>深色(&amp;D)</translation>
    </message>
    <message>
        <source>Choose light or dark colours</source>
        <translation>选择浅色或深色</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>视图(&amp;V)</translation>
    </message>
    <message>
        <source>S&amp;how panel</source>
        <translation>显示面板(&amp;H)</translation>
    </message>
    <message>
        <source>The &amp;desk alone, or back</source>
        <translation>只留桌面，或恢复(&amp;D)</translation>
    </message>
    <message>
        <source>Hide the strip of images and the inspector, or show them again</source>
        <translation>隐藏图像条和检查器，或重新显示</translation>
    </message>
    <message>
        <source>&amp;Colours</source>
        <translation>颜色(&amp;C)</translation>
    </message>
    <message>
        <source>What the window can show stands here</source>
        <translation>窗口可以显示的内容在此列出</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>帮助(&amp;H)</translation>
    </message>
    <message>
        <source>&amp;Manual</source>
        <translation>手册(&amp;M)</translation>
    </message>
    <message>
        <source>How to photograph, what a message means, who reads which file</source>
        <translation>如何拍摄、消息的含义、各文件由谁读取</translation>
    </message>
    <message>
        <source>Take the &amp;tour</source>
        <translation>导览(&amp;T)</translation>
    </message>
    <message>
        <source>Two minutes from one part of the window to the next</source>
        <translation>用两分钟看遍窗口的各部分</translation>
    </message>
    <message>
        <source>&amp;Find an action…</source>
        <translation>查找操作(&amp;F)…</translation>
    </message>
    <message>
        <source>Search everything that the menus can do</source>
        <translation>搜索菜单能做的一切</translation>
    </message>
</context>
<context>
    <name>ComparePanel</name>
    <message>
        <source>Compare</source>
        <translation>比较</translation>
    </message>
    <message>
        <source>Two results side by side: parameters, difference over the image, one image by both.</source>
        <translation>两个结果并排：参数、图像上的差异、两者处理的同一图像。</translation>
    </message>
    <message>
        <source>Left result</source>
        <translation>左侧结果</translation>
    </message>
    <message>
        <source>Right result</source>
        <translation>右侧结果</translation>
    </message>
    <message>
        <source>Parameters of both results</source>
        <translation>两个结果的参数</translation>
    </message>
    <message>
        <source>One image undistorted by both results</source>
        <translation>用两个结果校正的同一图像</translation>
    </message>
    <message>
        <source>Parameters</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Difference [px]</source>
        <translation>差异 [px]</translation>
    </message>
    <message>
        <source>Split image</source>
        <translation>分割图像</translation>
    </message>
    <message>
        <source>and</source>
        <translation>与</translation>
    </message>
    <message>
        <source>Every calibration keeps its result under a name</source>
        <translation>每次标定都以一个名称保存结果</translation>
    </message>
    <message>
        <source>There is one result. Calibrate again with other settings or other images, and compare the two here.</source>
        <translation>只有一个结果。请用其他设置或其他图像再次标定，然后在此比较两者。</translation>
    </message>
    <message>
        <source>Comparing…</source>
        <translation>正在比较…</translation>
    </message>
    <message>
        <source>Comparing {0} and {1}</source>
        <translation>正在比较 {0} 和 {1}</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>差异</translation>
    </message>
    <message>
        <source>{1} less {0}</source>
        <translation>{1} 减 {0}</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>以 σ 计</translation>
    </message>
    <message>
        <source>Over the standard deviation of a difference of independent estimates.
Results from the same images share their errors: even 1 is much then.</source>
        <translation>除以独立估计之差的标准差。
来自相同图像的结果共有误差：那时 1 就已经很大。</translation>
    </message>
    <message>
        <source>differs by more than 3 σ</source>
        <translation>相差超过 3 σ</translation>
    </message>
    <message>
        <source>Where corners were seen the two image the same point up to {0} px apart, {1} px RMS.</source>
        <translation>在见到角点之处，两者对同一点的成像最多相差 {0} px，RMS {1} px。</translation>
    </message>
    <message>
        <source>Of the parameters {0} differs most, by {1:.1f} σ.</source>
        <translation>参数中 {0} 差别最大，为 {1:.1f} σ。</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>正在校正 {0}</translation>
    </message>
</context>
<context>
    <name>ConvergencePanel</name>
    <message>
        <source>Convergence</source>
        <translation>收敛</translation>
    </message>
    <message>
        <source>The cost after each step, also while it runs.</source>
        <translation>每一步之后的代价，运行中也显示。</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>迭代</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>代价 c</translation>
    </message>
    <message>
        <source>The sum of squared residuals that Stage II minimises, after each step.</source>
        <translation>第二阶段使之最小的残差平方和，每一步之后。</translation>
    </message>
    <message>
        <source>Calibrating…</source>
        <translation>正在标定…</translation>
    </message>
    <message>
        <source>Calibrating: iteration {0}, RMS residual {1:.4f} {2}</source>
        <translation>正在标定：第 {0} 次迭代，RMS 残差 {1:.4f} {2}</translation>
    </message>
    <message>
        <source>The camera is known from a file: nothing was solved.</source>
        <translation>相机来自文件：没有求解。</translation>
    </message>
    <message>
        <source>Weighted RMS residual {0:.4f} {1}; {2}.</source>
        <translation>加权 RMS 残差 {0:.4f} {1}；{2}。</translation>
    </message>
    <message>
        <source>RMS residual {0:.4f} {1}; {2}.</source>
        <translation>RMS 残差 {0:.4f} {1}；{2}。</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>参考 px</translation>
    </message>
    <message>
        <source>Converged after {0} iterations.</source>
        <translation>经 {0} 次迭代收敛。</translation>
    </message>
    <message>
        <source>Converged after {0} iterations, with assumptions on what the views leave open.</source>
        <translation>经 {0} 次迭代收敛，对视图未确定之处作了假设。</translation>
    </message>
    <message>
        <source>Stopped after {0} iterations: the best so far is kept, but it is not the optimum.</source>
        <translation>在 {0} 次迭代后停止：保留目前最好的，但不是最优解。</translation>
    </message>
    <message>
        <source>Not converged: all {0} iterations were used. Allow more, or hold parameters that the views do not determine.</source>
        <translation>未收敛：{0} 次迭代已用完。请允许更多，或固定视图不能确定的参数。</translation>
    </message>
</context>
<context>
    <name>CornerBar</name>
    <message>
        <source>&amp;Done</source>
        <translation>完成(&amp;D)</translation>
    </message>
    <message>
        <source>Drag a corner to move it, Delete removes it, a click on a red ring finds it again. Ctrl: do not snap.</source>
        <translation>拖动角点可移动，Delete 删除，点击红圈可重新找到。Ctrl：不吸附。</translation>
    </message>
    <message>
        <source>&amp;Turn 90°</source>
        <translation>旋转 90°(&amp;T)</translation>
    </message>
    <message>
        <source>Count from the board&apos;s next corner</source>
        <translation>从标定板的下一个角开始计数</translation>
    </message>
    <message>
        <source>F&amp;lip</source>
        <translation>翻转(&amp;L)</translation>
    </message>
    <message>
        <source>Count columns from the other end: for mirrored images</source>
        <translation>从另一端数列：用于镜像图像</translation>
    </message>
</context>
<context>
    <name>CostChoice</name>
    <message>
        <source>error in the image</source>
        <translation>图像中的误差</translation>
    </message>
    <message>
        <source>Distance between measured and predicted corners, px. The noise is in the image: this gives the smallest standard deviations.</source>
        <translation>测得与预测角点的距离，px。噪声在图像中：这样标准差最小。</translation>
    </message>
    <message>
        <source>error on the reference plane</source>
        <translation>参考平面上的误差</translation>
    </message>
    <message>
        <source>Distance between the corners registered on the board and where they should be. Far and tilted views weigh more.</source>
        <translation>配准到板上的角点与其应在位置的距离。远而倾斜的视图权重更大。</translation>
    </message>
    <message>
        <source>as printed in the paper</source>
        <translation>按论文所印</translation>
    </message>
    <message>
        <source>The formulation of the paper to the letter, to reproduce its tables.</source>
        <translation>逐字按照论文的公式，以重现其表格。</translation>
    </message>
    <message>
        <source>Minimise</source>
        <translation>最小化</translation>
    </message>
</context>
<context>
    <name>CoveragePanel</name>
    <message>
        <source>Coverage</source>
        <translation>覆盖</translation>
    </message>
    <message>
        <source>What the views cover of the image, of tilts and distances, and which to add next.</source>
        <translation>视图在图像、倾角和距离上覆盖了什么，下一步应添加什么。</translation>
    </message>
    <message>
        <source>Where corners were seen. The lens correction is extrapolated beyond them.</source>
        <translation>见到角点之处。在此之外镜头校正是外推。</translation>
    </message>
    <message>
        <source>tilt to the right</source>
        <translation>向右倾斜</translation>
    </message>
    <message>
        <source>tilt upwards</source>
        <translation>向上倾斜</translation>
    </message>
    <message>
        <source>Each view&apos;s tilt, towards the side of the board that is farther away.
Points on all sides, 20° to 45° out, determine the focal length best.</source>
        <translation>每个视图的倾斜，朝向标定板较远的一侧。
四周 20° 到 45° 的点最能确定焦距。</translation>
    </message>
    <message>
        <source>view</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>距离</translation>
    </message>
    <message>
        <source>From the camera to the middle of the corners seen.</source>
        <translation>从相机到所见角点的中心。</translation>
    </message>
    <message>
        <source>circles in a cell</source>
        <translation>每格圆数</translation>
    </message>
    <message>
        <source>corners in a cell</source>
        <translation>每格角点数</translation>
    </message>
    <message>
        <source>view (distance in mm{0})</source>
        <translation>视图（距离 mm{0}）</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Which view would help most? Working…</source>
        <translation>哪个视图最有帮助？正在计算…</translation>
    </message>
    <message>
        <source>Looking for the next view</source>
        <translation>正在寻找下一个视图</translation>
    </message>
    <message>
        <source>Which view would help most was not examined.</source>
        <translation>没有检查哪个视图最有帮助。</translation>
    </message>
    <message>
        <source>The next view (red): {0} {1}</source>
        <translation>下一个视图（红）：{0} {1}</translation>
    </message>
    <message>
        <source>The next view (red): {0} It hardly lowers the uncertainty of {1} px.</source>
        <translation>下一个视图（红）：{0} 它几乎不降低 {1} px 的不确定度。</translation>
    </message>
    <message>
        <source>The next view (red): {0} It lowers the uncertainty over the image from {1} to {2} px.</source>
        <translation>下一个视图（红）：{0} 它把图像上的不确定度从 {1} 降到 {2} px。</translation>
    </message>
</context>
<context>
    <name>Detector</name>
    <message>
        <source>Finding corners</source>
        <translation>正在寻找角点</translation>
    </message>
    <message>
        <source>Detect again</source>
        <translation>重新检测</translation>
    </message>
    <message>
        <source>The search was stopped: {0} of {1} images have been searched. Calibrate searches the others.</source>
        <translation>搜索已停止：已搜索 {1} 幅图像中的 {0} 幅。“标定”会搜索其余的。</translation>
    </message>
</context>
<context>
    <name>DifferenceMap</name>
    <message>
        <source>difference [px]</source>
        <translation>差异 [px]</translation>
    </message>
    <message>
        <source>Distance between a far point&apos;s images by the two calibrations that are compared,
after the rotation that brings the two closest where corners (dots) were seen.</source>
        <translation>一个远处的点在所比较的两个标定中成像的距离，已去除使两者
在见到角点（小点）之处最接近的旋转。</translation>
    </message>
    <message>
        <source>The two calibrations do not differ (below {0:g} px).</source>
        <translation>两个标定没有差异（小于 {0:g} px）。</translation>
    </message>
    <message>
        <source>At most {0} px near corners: point to read it</source>
        <translation>角点附近最多 {0} px：指向即可读数</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: {2:.3f} px</source>
        <translation>u {0:.0f}，v {1:.0f}：{2:.3f} px</translation>
    </message>
</context>
<context>
    <name>DistortionPanel</name>
    <message>
        <source>Distortion</source>
        <translation>畸变</translation>
    </message>
    <message>
        <source>How far the lens moves each pixel from where an ideal camera would see it.</source>
        <translation>镜头把每个像素从理想相机所见之处移动了多少。</translation>
    </message>
    <message>
        <source>Complete</source>
        <translation>全部</translation>
    </message>
    <message>
        <source>Radial part</source>
        <translation>径向部分</translation>
    </message>
    <message>
        <source>Decentering part</source>
        <translation>偏心部分</translation>
    </message>
    <message>
        <source>Part of the distortion</source>
        <translation>畸变的部分</translation>
    </message>
    <message>
        <source>Radial: along rays from the centre. Decentering: from lenses out of line.</source>
        <translation>径向：沿从中心出发的射线。偏心：来自未对准的镜片。</translation>
    </message>
    <message>
        <source>Only &amp;where corners were seen</source>
        <translation>只在见到角点之处(&amp;W)</translation>
    </message>
    <message>
        <source>Beyond the corners&apos; convex hull the correction is an extrapolation.</source>
        <translation>在角点的凸包之外，校正是外推。</translation>
    </message>
    <message>
        <source>displacement d [px]</source>
        <translation>位移 d [px]</translation>
    </message>
    <message>
        <source>+ array&apos;s centre   × principal point   → gradient</source>
        <translation>+ 传感器中心   × 主点   → 梯度</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})</source>
        <translation>u {0:.0f}，v {1:.0f}：d = {2:.2f} px ({3:+.2f}, {4:+.2f})</translation>
    </message>
    <message>
        <source>d is at most {0} px: point to read it</source>
        <translation>d 最大 {0} px：指向即可读数</translation>
    </message>
</context>
<context>
    <name>DividedImages</name>
    <message>
        <source>Image {0} and {1}</source>
        <translation>图像 {0} 和 {1}</translation>
    </message>
    <message>
        <source>Drag the divider, or move it by the arrow keys. The wheel magnifies (+ and −); drag to look around, double-click or 0 for the whole image.</source>
        <translation>拖动分割线，或用方向键移动。滚轮放大（+ 和 −）；拖动可移动视野，双击或 0 显示整幅图像。</translation>
    </message>
</context>
<context>
    <name>DoneList</name>
    <message>
        <source>What was done</source>
        <translation>已做的工作</translation>
    </message>
    <message>
        <source>why</source>
        <translation>原因</translation>
    </message>
    <message>
        <source>Show what speaks for it</source>
        <translation>显示其依据</translation>
    </message>
    <message>
        <source>Make camera better</source>
        <translation>改进相机</translation>
    </message>
    <message>
        <source>Take this step back; redo brings it again</source>
        <translation>撤回这一步；重做可恢复</translation>
    </message>
    <message>
        <source>undo</source>
        <translation>撤销</translation>
    </message>
    <message>
        <source>Lens: the paper&apos;s model; no other predicts better</source>
        <translation>镜头：论文的模型；没有其他模型预测更好</translation>
    </message>
    <message>
        <source>Lens: {0}, which predicts best</source>
        <translation>镜头：{0}，预测最好</translation>
    </message>
    <message>
        <source>{0} of {1} photographs could not be used: {2}</source>
        <translation>{1} 张照片中有 {0} 张无法使用：{2}</translation>
    </message>
    <message>
        <source>Show the photograph</source>
        <translation>显示该照片</translation>
    </message>
</context>
<context>
    <name>ExportDialog</name>
    <message>
        <source>Export</source>
        <translation>导出</translation>
    </message>
    <message>
        <source>Formats</source>
        <translation>格式</translation>
    </message>
    <message>
        <source>The file&apos;s text</source>
        <translation>文件的文本</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>结果</translation>
    </message>
    <message>
        <source>Read by</source>
        <translation>可读取的程序</translation>
    </message>
    <message>
        <source>Keeps</source>
        <translation>保留</translation>
    </message>
    <message>
        <source>Loses</source>
        <translation>丢失</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Largest error</source>
        <translation>最大误差</translation>
    </message>
    <message>
        <source>&amp;Copy text</source>
        <translation>复制文本(&amp;C)</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>保存(&amp;S)…</translation>
    </message>
    <message>
        <source>Save &amp;all…</source>
        <translation>全部保存(&amp;A)…</translation>
    </message>
    <message>
        <source>Every format in a folder, with a page that tells who reads which file</source>
        <translation>把所有格式写入文件夹，并附一页说明各文件由谁读取</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>正在计算…</translation>
    </message>
    <message>
        <source>Preparing {0}</source>
        <translation>正在准备 {0}</translation>
    </message>
    <message>
        <source>A binary file of {0:.1f} MB</source>
        <translation>{0:.1f} MB 的二进制文件</translation>
    </message>
    <message>
        <source>none: nothing is refitted</source>
        <translation>无：没有重新拟合</translation>
    </message>
    <message>
        <source>unlimited in parts of the image that no corner covers</source>
        <translation>在没有角点的图像部分没有界限</translation>
    </message>
    <message>
        <source>{0:.3g} px over the whole image</source>
        <translation>整幅图像 {0:.3g} px</translation>
    </message>
    <message>
        <source>The text is on the clipboard.</source>
        <translation>文本已在剪贴板上。</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>正在写入 {0}</translation>
    </message>
    <message>
        <source>Folder for all formats</source>
        <translation>所有格式的文件夹</translation>
    </message>
    <message>
        <source>Writing all formats</source>
        <translation>正在写入所有格式</translation>
    </message>
    <message>
        <source>{0} of {1} formats are in {2}</source>
        <translation>{1} 种格式中的 {0} 种在 {2}</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>已保存为 {0}</translation>
    </message>
</context>
<context>
    <name>Files</name>
    <message>
        <source>Only the project {0} is opened, without the {1} other files.</source>
        <translation>只打开项目 {0}，不含其他 {1} 个文件。</translation>
    </message>
    <message>
        <source>Camera file</source>
        <translation>相机文件</translation>
    </message>
    <message>
        <source>Camera files (*)</source>
        <translation>相机文件 (*)</translation>
    </message>
    <message>
        <source>Not added, as no image can be read there: {0}.</source>
        <translation>未添加，因为其中没有可读的图像：{0}。</translation>
    </message>
    <message>
        <source>By their names these are photographs of several cameras: {0}. File › Several cameras calibrates each, and how they stand to each other.</source>
        <translation>从文件名看，这些照片来自多台相机：{0}。“文件 › 多台相机”可标定每台相机及其相互位置。</translation>
    </message>
    <message>
        <source>Folder of images</source>
        <translation>图像文件夹</translation>
    </message>
    <message>
        <source>Add images</source>
        <translation>添加图像</translation>
    </message>
    <message>
        <source>Images ({0});;All files, also videos (*)</source>
        <translation>图像 ({0});;所有文件，包括视频 (*)</translation>
    </message>
    <message>
        <source>Open project</source>
        <translation>打开项目</translation>
    </message>
    <message>
        <source>Projects (*.json)</source>
        <translation>项目 (*.json)</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>正在打开 {0}</translation>
    </message>
    <message>
        <source>Replace the project</source>
        <translation>替换项目</translation>
    </message>
    <message>
        <source>{0} has been saved by another window or program since it was opened here. Replace what is there now?</source>
        <translation>{0} 在此处打开之后已被另一个窗口或程序保存。要替换现有内容吗？</translation>
    </message>
    <message>
        <source>Save project</source>
        <translation>保存项目</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>未保存的更改</translation>
    </message>
    <message>
        <source>Save the changes to this project?</source>
        <translation>要保存此项目的更改吗？</translation>
    </message>
    <message>
        <source>What you discard is kept for a while in {0}.</source>
        <translation>放弃的内容会在 {0} 中保留一段时间。</translation>
    </message>
    <message>
        <source>Discard the changes without a copy?</source>
        <translation>不留副本就放弃更改吗？</translation>
    </message>
    <message>
        <source>Folder that holds the missing images</source>
        <translation>存放缺失图像的文件夹</translation>
    </message>
    <message>
        <source>Relocate images</source>
        <translation>重新定位图像</translation>
    </message>
    <message>
        <source>Found {0} of {1} missing images in {2}.</source>
        <translation>在 {2} 中找到 {1} 幅缺失图像中的 {0} 幅。</translation>
    </message>
    <message>
        <source>Looking for images</source>
        <translation>正在寻找图像</translation>
    </message>
    <message>
        <source>Rename result</source>
        <translation>重命名结果</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Delete {0}</source>
        <translation>删除 {0}</translation>
    </message>
    <message>
        <source>Folder for the images</source>
        <translation>存放图像的文件夹</translation>
    </message>
    <message>
        <source>Writing images</source>
        <translation>正在写入图像</translation>
    </message>
    <message>
        <source>Wrote {0} images to {1}.</source>
        <translation>已将 {0} 幅图像写入 {1}。</translation>
    </message>
    <message>
        <source>Wrote {0} image to {1}.</source>
        <translation>已将 {0} 幅图像写入 {1}。</translation>
    </message>
    <message>
        <source>Replace files</source>
        <translation>替换文件</translation>
    </message>
    <message>
        <source>In {0} there are files of these names, not written by this program:</source>
        <translation>{0} 中有这些名称的文件，不是由本程序写出的：</translation>
    </message>
    <message>
        <source>Replace them?</source>
        <translation>要替换吗？</translation>
    </message>
</context>
<context>
    <name>FilmStrip</name>
    <message>
        <source>Images</source>
        <translation>图像</translation>
    </message>
    <message>
        <source>Leave the images out whose error is above the threshold</source>
        <translation>排除误差高于阈值的图像</translation>
    </message>
    <message>
        <source>Refit at &amp;once</source>
        <translation>立即重新拟合(&amp;O)</translation>
    </message>
    <message>
        <source>Calibrate again at once when images are excluded or included. The shown result is replaced; undo brings it back.</source>
        <translation>排除或加入图像时立即重新标定。显示的结果被替换；撤销可恢复。</translation>
    </message>
    <message>
        <source>Sort by &amp;name</source>
        <translation>按名称排序(&amp;N)</translation>
    </message>
    <message>
        <source>Sort by &amp;status</source>
        <translation>按状态排序(&amp;S)</translation>
    </message>
    <message>
        <source>Sort by lar&amp;gest error</source>
        <translation>按最大误差排序(&amp;G)</translation>
    </message>
    <message>
        <source>Put the images in this order</source>
        <translation>按此顺序排列图像</translation>
    </message>
    <message>
        <source>Include {0}</source>
        <translation>加入 {0}</translation>
    </message>
    <message>
        <source>Exclude {0}</source>
        <translation>排除 {0}</translation>
    </message>
    <message>
        <source>Remove {0}</source>
        <translation>移除 {0}</translation>
    </message>
    <message>
        <source>{0} images</source>
        <translation>{0} 幅图像</translation>
    </message>
    <message>
        <source>Ex&amp;clude or include</source>
        <translation>排除或加入(&amp;C)</translation>
    </message>
    <message>
        <source>Leave the selected images out of the calibration, or take them in again.</source>
        <translation>标定时排除所选图像，或重新加入。</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>重新检测(&amp;D)</translation>
    </message>
    <message>
        <source>Forget what was found in the selected images and search them anew.</source>
        <translation>忘掉在所选图像中找到的内容并重新搜索。</translation>
    </message>
    <message>
        <source>&amp;Remove from project</source>
        <translation>从项目移除(&amp;R)</translation>
    </message>
    <message>
        <source>Take the selected images out of the project. The files stay.</source>
        <translation>把所选图像从项目中取出。文件保留。</translation>
    </message>
    <message>
        <source>No image is selected in the list.</source>
        <translation>列表中没有选中图像。</translation>
    </message>
    <message>
        <source>{0} px: {1} above · leave out</source>
        <translation>{0} px：{1} 幅超出 · 排除</translation>
    </message>
    <message>
        <source>{0} px: all are above</source>
        <translation>{0} px：全部超出</translation>
    </message>
    <message>
        <source>{0} px: none above</source>
        <translation>{0} px：无超出</translation>
    </message>
</context>
<context>
    <name>FindingRow</name>
    <message>
        <source>{0} times better once mended</source>
        <translation>修正后好 {0} 倍</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>详情</translation>
    </message>
    <message>
        <source>Show the figures and what to do</source>
        <translation>显示数据和应做的事</translation>
    </message>
    <message>
        <source>Show the evidence</source>
        <translation>显示证据</translation>
    </message>
</context>
<context>
    <name>FleetDialog</name>
    <message>
        <source>Fleet {0}</source>
        <translation>机群 {0}</translation>
    </message>
    <message>
        <source>{0} cameras. Failing: {1}. Unlike the others of their image size and lens model: {2}. Changed: {3}.</source>
        <translation>{0} 台相机。不合格：{1}。与同图像尺寸和镜头模型的其他相机不同：{2}。有变化：{3}。</translation>
    </message>
    <message>
        <source>Camera, serial number, reason…</source>
        <translation>相机、序列号、原因…</translation>
    </message>
    <message>
        <source>Filter</source>
        <translation>筛选</translation>
    </message>
    <message>
        <source>Which cameras are shown</source>
        <translation>显示哪些相机</translation>
    </message>
    <message>
        <source>all</source>
        <translation>全部</translation>
    </message>
    <message>
        <source>failing</source>
        <translation>不合格</translation>
    </message>
    <message>
        <source>unlike the others</source>
        <translation>与其他不同</translation>
    </message>
    <message>
        <source>changed</source>
        <translation>有变化</translation>
    </message>
    <message>
        <source>First photograph of the camera</source>
        <translation>相机的第一张照片</translation>
    </message>
    <message>
        <source>&amp;Open camera</source>
        <translation>打开相机(&amp;O)</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>序列号</translation>
    </message>
    <message>
        <source>Date</source>
        <translation>日期</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>结论</translation>
    </message>
    <message>
        <source>pass</source>
        <translation>合格</translation>
    </message>
    <message>
        <source>fail</source>
        <translation>不合格</translation>
    </message>
    <message>
        <source>Whether the camera keeps the limits of its fleet</source>
        <translation>相机是否满足机群的限值</translation>
    </message>
    <message>
        <source>Views</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Root mean square residual</source>
        <translation>均方根残差</translation>
    </message>
    <message>
        <source>Standard deviation of one coordinate of a corner</source>
        <translation>角点一个坐标的标准差</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>角点</translation>
    </message>
    <message>
        <source>Error, edge</source>
        <translation>误差，边缘</translation>
    </message>
    <message>
        <source>Error of a pixel at the image&apos;s edge, one standard deviation</source>
        <translation>图像边缘的像素误差，一个标准差</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>差异</translation>
    </message>
    <message>
        <source>Distance from the median camera of the same image size and lens model, rms over the image, after the rotation that brings both together</source>
        <translation>与同图像尺寸和镜头模型的中位相机的距离，图像上均方根，已去除使两者接近的旋转</translation>
    </message>
    <message>
        <source>In σ</source>
        <translation>以 σ 计</translation>
    </message>
    <message>
        <source>The difference in standard deviations of the fleet</source>
        <translation>以机群标准差计的差异</translation>
    </message>
    <message>
        <source>Changed by</source>
        <translation>变化量</translation>
    </message>
    <message>
        <source>Difference from the last calibration of the serial number</source>
        <translation>与该序列号上一次标定的差异</translation>
    </message>
    <message>
        <source>It is unlike the others of its kind.</source>
        <translation>它与同类的其他相机不同。</translation>
    </message>
    <message>
        <source>It has changed since {0}, by {1:.2g} px at most.</source>
        <translation>自 {0} 以来它有变化，最多 {1:.2g} px。</translation>
    </message>
    <message>
        <source>It passes.</source>
        <translation>合格。</translation>
    </message>
</context>
<context>
    <name>GlassRow</name>
    <message>
        <source>If the board is of glass, printed true to {0:g} mm and flat to {1:g} mm: {2} px.</source>
        <translation>如果标定板是玻璃的，印刷准确到 {0:g} mm，平整到 {1:g} mm：{2} px。</translation>
    </message>
    <message>
        <source>It is of glass</source>
        <translation>是玻璃的</translation>
    </message>
</context>
<context>
    <name>GoodSet</name>
    <message>
        <source>filling the image</source>
        <translation>充满图像</translation>
    </message>
    <message>
        <source>tilted back</source>
        <translation>向后倾斜</translation>
    </message>
    <message>
        <source>tilted to a side</source>
        <translation>向一侧倾斜</translation>
    </message>
    <message>
        <source>in one corner</source>
        <translation>在一个角</translation>
    </message>
    <message>
        <source>in the others</source>
        <translation>在其他角</translation>
    </message>
    <message>
        <source>turned upright</source>
        <translation>竖直放置</translation>
    </message>
    <message>
        <source>A good set of photographs</source>
        <translation>一组好照片</translation>
    </message>
    <message>
        <source>10 to 20 of one flat board: sharp, evenly lit, with the focus and zoom that the camera will have at work.</source>
        <translation>一块平整标定板的 10 到 20 张：清晰、光照均匀，对焦和变焦与相机工作时相同。</translation>
    </message>
</context>
<context>
    <name>HandEyeDialog</name>
    <message>
        <source>Hand and eye</source>
        <translation>手眼标定</translation>
    </message>
    <message>
        <source>Robot&apos;s &amp;poses…</source>
        <translation>机器人位姿(&amp;P)…</translation>
    </message>
    <message>
        <source>CSV, JSON, text or MAT: a pose for each photograph, by its name or in their order, in any units and convention</source>
        <translation>CSV、JSON、文本或 MAT：每张照片一个位姿，按照片名或照片顺序，单位和约定不限</translation>
    </message>
    <message>
        <source>Where the camera is</source>
        <translation>相机的位置</translation>
    </message>
    <message>
        <source>as the poses tell</source>
        <translation>由位姿判断</translation>
    </message>
    <message>
        <source>in the hand</source>
        <translation>在手上</translation>
    </message>
    <message>
        <source>beside the robot</source>
        <translation>在机器人旁</translation>
    </message>
    <message>
        <source>The tool&apos;s point in the hand&apos;s frame</source>
        <translation>手坐标系中的工具点</translation>
    </message>
    <message>
        <source>X, Y, Z: the board</source>
        <translation>X, Y, Z：标定板</translation>
    </message>
    <message>
        <source>Where ± is stated, as 0, 0, 120; if empty, it is where the board was</source>
        <translation>给出 ± 的位置，例如 0, 0, 120；为空时取标定板所在处</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>保存(&amp;S)…</translation>
    </message>
    <message>
        <source>Choose the file of the poses at which the robot stood for the photographs.</source>
        <translation>请选择拍摄照片时机器人位姿的文件。</translation>
    </message>
    <message>
        <source>The side of a square is not known, and the robot&apos;s poses have lengths. Close this, and answer in the window how long the squares are.</source>
        <translation>方格边长未知，而机器人位姿含有长度。请关闭此对话框，并在窗口中回答方格边长。</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Tool at</source>
        <translation>工具位于</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Poses of the robot</source>
        <translation>机器人位姿</translation>
    </message>
    <message>
        <source>Poses (*.csv *.json *.txt *.mat);;All files (*)</source>
        <translation>位姿 (*.csv *.json *.txt *.mat);;所有文件 (*)</translation>
    </message>
    <message>
        <source>{0} is no point X, Y, Z, such as 0, 0, 120.</source>
        <translation>{0} 不是形如 0, 0, 120 的点 X, Y, Z。</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>正在计算…</translation>
    </message>
    <message>
        <source>Finding hand and eye</source>
        <translation>正在求手眼关系</translation>
    </message>
    <message>
        <source>Camera in the hand</source>
        <translation>相机在手坐标系</translation>
    </message>
    <message>
        <source>Board in the base</source>
        <translation>标定板在基座坐标系</translation>
    </message>
    <message>
        <source>Camera in the base</source>
        <translation>相机在基座坐标系</translation>
    </message>
    <message>
        <source>Board in the hand</source>
        <translation>标定板在手坐标系</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>位姿</translation>
    </message>
    <message>
        <source>rotation vector, {0}</source>
        <translation>旋转向量，{0}</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>degrees</source>
        <translation>度</translation>
    </message>
    <message>
        <source>The most likely error of the robot&apos;s pose</source>
        <translation>机器人位姿最可能的误差</translation>
    </message>
    <message>
        <source>Photograph</source>
        <translation>照片</translation>
    </message>
    <message>
        <source>Robot off by</source>
        <translation>机器人偏移</translation>
    </message>
    <message>
        <source>Turned by</source>
        <translation>转角偏差</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>已用</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>已排除</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>&amp;Use again</source>
        <translation>重新使用(&amp;U)</translation>
    </message>
    <message>
        <source>&amp;Leave out</source>
        <translation>不使用(&amp;L)</translation>
    </message>
    <message>
        <source>Save hand and eye</source>
        <translation>保存手眼标定</translation>
    </message>
    <message>
        <source>Hand and eye (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</source>
        <translation>手眼标定 (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>正在写入 {0}</translation>
    </message>
    <message>
        <source>Saved as {0}.</source>
        <translation>已保存为 {0}。</translation>
    </message>
</context>
<context>
    <name>Header</name>
    <message>
        <source>Set-up</source>
        <translation>设置</translation>
    </message>
    <message>
        <source>The board, the lens, and how to calibrate</source>
        <translation>标定板、镜头和标定方式</translation>
    </message>
    <message>
        <source>Report…</source>
        <translation>报告…</translation>
    </message>
    <message>
        <source>Write what is known as PDF or a web page (Ctrl+P)</source>
        <translation>把已知信息写成 PDF 或网页 (Ctrl+P)</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>导出…</translation>
    </message>
    <message>
        <source>Write the camera for another program (Ctrl+E)</source>
        <translation>为其他程序写出相机 (Ctrl+E)</translation>
    </message>
    <message>
        <source>Show the verdict, or hide it again</source>
        <translation>显示结论，或再次隐藏</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>未命名</translation>
    </message>
    <message>
        <source>1 photograph</source>
        <translation>1 张照片</translation>
    </message>
    <message>
        <source>{0} photographs</source>
        <translation>{0} 张照片</translation>
    </message>
    <message>
        <source>{0} of {1} photographs usable</source>
        <translation>{1} 张照片中 {0} 张可用</translation>
    </message>
</context>
<context>
    <name>HistogramPlot</name>
    <message>
        <source>density</source>
        <translation>密度</translation>
    </message>
    <message>
        <source>Rayleigh s</source>
        <translation>瑞利 s</translation>
    </message>
    <message>
        <source>Gaussian σ</source>
        <translation>高斯 σ</translation>
    </message>
    <message>
        <source>mean {0:.4f}, SD {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</source>
        <translation>均值 {0:.4f}，标准差 {1:.4f} {4}&lt;br&gt;{2} = {3:.4f} {4}</translation>
    </message>
    <message>
        <source>; {0} farther out</source>
        <translation>；更远处 {0} 个</translation>
    </message>
</context>
<context>
    <name>Histograms</name>
    <message>
        <source>Component of the residuals</source>
        <translation>残差的分量</translation>
    </message>
    <message>
        <source>The residuals&apos; components on the reference plane, or their length e′.</source>
        <translation>残差在参考平面上的分量，或其长度 e′。</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>参考 px</translation>
    </message>
    <message>
        <source>{0}, real</source>
        <translation>{0}，真实</translation>
    </message>
    <message>
        <source>{0}, synthetic</source>
        <translation>{0}，合成</translation>
    </message>
</context>
<context>
    <name>HistogramsPanel</name>
    <message>
        <source>Histograms</source>
        <translation>直方图</translation>
    </message>
    <message>
        <source>How the residuals are distributed, beside a Gaussian and a Rayleigh distribution.</source>
        <translation>残差如何分布，并与高斯分布和瑞利分布对照。</translation>
    </message>
    <message>
        <source>Noise of equal size in all directions has Gaussian components and lengths after Rayleigh.
Heavy tails mean bad corners; two humps, a board that is not flat or a wrong model.</source>
        <translation>各方向大小相同的噪声，其分量为高斯分布，长度为瑞利分布。
厚尾意味着角点不好；双峰意味着板不平或模型错误。</translation>
    </message>
</context>
<context>
    <name>ImageModel</name>
    <message>
        <source>changed · {0}</source>
        <translation>已更改 · {0}</translation>
    </message>
    <message>
        <source>{0}, error {1:.3f} px</source>
        <translation>{0}，误差 {1:.3f} px</translation>
    </message>
    <message>
        <source>The file has changed since its corners were found: detect again.</source>
        <translation>找到角点之后文件已更改：请重新检测。</translation>
    </message>
</context>
<context>
    <name>ImagePage</name>
    <message>
        <source>Tools</source>
        <translation>工具</translation>
    </message>
    <message>
        <source>Layers</source>
        <translation>图层</translation>
    </message>
    <message>
        <source>Choose what is drawn over the image</source>
        <translation>选择在图像上绘制什么</translation>
    </message>
    <message>
        <source>&amp;Mark board</source>
        <translation>标记标定板(&amp;M)</translation>
    </message>
    <message>
        <source>Point at the board&apos;s four outermost corners</source>
        <translation>指出标定板最外侧的四个角点</translation>
    </message>
    <message>
        <source>&amp;Edit corners</source>
        <translation>编辑角点(&amp;E)</translation>
    </message>
    <message>
        <source>Move, remove and restore single corners; turn the axes</source>
        <translation>移动、删除和恢复单个角点；旋转坐标轴</translation>
    </message>
    <message>
        <source>Mark</source>
        <translation>标记</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>编辑</translation>
    </message>
    <message>
        <source>&amp;Fit</source>
        <translation>适合(&amp;F)</translation>
    </message>
    <message>
        <source>Show the whole image</source>
        <translation>显示整幅图像</translation>
    </message>
    <message>
        <source>&amp;1:1</source>
        <translation>&amp;1:1</translation>
    </message>
    <message>
        <source>Show the image&apos;s pixels as pixels of the screen</source>
        <translation>图像像素与屏幕像素一一对应</translation>
    </message>
    <message>
        <source>No image is shown that can be read.</source>
        <translation>没有显示可读的图像。</translation>
    </message>
    <message>
        <source>, {0} px</source>
        <translation>，{0} px</translation>
    </message>
    <message>
        <source>corner in row {0}, column {1}: u {2:.3f}, v {3:.3f} px</source>
        <translation>角点 行 {0}，列 {1}：u {2:.3f}，v {3:.3f} px</translation>
    </message>
    <message>
        <source>; residual Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px</source>
        <translation>；残差 Δu {0:+.3f}，Δv {1:+.3f}，{2:.3f} px</translation>
    </message>
    <message>
        <source>u {0:.2f}  v {1:.2f} px</source>
        <translation>u {0:.2f}  v {1:.2f} px</translation>
    </message>
    <message>
        <source>   grey {0}</source>
        <translation>   灰度 {0}</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its place</source>
        <translation>   角点：行 {0}，列 {1}；点击查看位置</translation>
    </message>
    <message>
        <source>   corner: row {0}, column {1}; click to see its residual</source>
        <translation>   角点：行 {0}，列 {1}；点击查看残差</translation>
    </message>
</context>
<context>
    <name>Inspector</name>
    <message>
        <source>Is the camera still good?

Drop new photographs of the board here: they check it and change nothing.

Dropped on the left they join the project.</source>
        <translation>相机仍然好用吗？

把标定板的新照片拖放到这里：它们检查相机，不改变任何东西。

拖放到左侧则加入项目。</translation>
    </message>
</context>
<context>
    <name>InstantView</name>
    <message>
        <source>Photographs of an instant</source>
        <translation>同一时刻的照片</translation>
    </message>
</context>
<context>
    <name>KnownCameraChoice</name>
    <message>
        <source>calibrated</source>
        <translation>已标定</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>选择…</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>重新标定</translation>
    </message>
    <message>
        <source>Hold the camera of a file of this or another program, and locate the board in photographs with it. Such a file can also be dropped on the window.</source>
        <translation>固定本程序或其他程序文件中的相机，并用它在照片中定位标定板。此类文件也可拖放到窗口。</translation>
    </message>
    <message>
        <source>Give the camera of the file up: calibrate one from the photographs.</source>
        <translation>放弃文件中的相机：用照片标定。</translation>
    </message>
</context>
<context>
    <name>KnownCameras</name>
    <message>
        <source>Known camera</source>
        <translation>已知相机</translation>
    </message>
    <message>
        <source>The camera of {0} ({1}) stays as it is: Calibrate only finds where the board was. To calibrate another, take it away in the Set-up.</source>
        <translation>来自 {0}（{1}）的相机保持不变：标定只确定标定板的位置。若要标定其他相机，请在设置中将其移除。</translation>
    </message>
    <message>
        <source>Of {0} camera files it is the first.</source>
        <translation>它是 {0} 个相机文件中的第一个。</translation>
    </message>
</context>
<context>
    <name>LayerMenu</name>
    <message>
        <source>Residuals × </source>
        <translation>残差 × </translation>
    </message>
    <message>
        <source>How many times as long as they are residuals are drawn</source>
        <translation>残差绘制为实际长度的多少倍</translation>
    </message>
    <message>
        <source>Magnification of residuals</source>
        <translation>残差的放大倍数</translation>
    </message>
    <message>
        <source>&amp;Region of interest</source>
        <translation>感兴趣区域(&amp;R)</translation>
    </message>
    <message>
        <source>The part of the image that was searched (yellow outline)</source>
        <translation>搜索过的图像部分（黄色轮廓）</translation>
    </message>
    <message>
        <source>First &amp;estimates</source>
        <translation>初始估计(&amp;E)</translation>
    </message>
    <message>
        <source>Corners to the nearest pixel, by Harris&apos; detector (red +)</source>
        <translation>由 Harris 检测器得到的最近像素处的角点（红色 +）</translation>
    </message>
    <message>
        <source>Refi&amp;ned corners</source>
        <translation>精化角点(&amp;N)</translation>
    </message>
    <message>
        <source>Corners at the saddle point of the grey levels (yellow +)</source>
        <translation>灰度鞍点处的角点（黄色 +）</translation>
    </message>
    <message>
        <source>&amp;Order and axes</source>
        <translation>顺序和坐标轴(&amp;O)</translation>
    </message>
    <message>
        <source>The numbering of the corners: origin, rows, and the board&apos;s axes</source>
        <translation>角点的编号：原点、行和标定板的坐标轴</translation>
    </message>
    <message>
        <source>Re&amp;projection</source>
        <translation>重投影(&amp;P)</translation>
    </message>
    <message>
        <source>Where the calibration expects the corners (blue circles)</source>
        <translation>标定预期的角点位置（蓝色圆圈）</translation>
    </message>
    <message>
        <source>Re&amp;siduals</source>
        <translation>残差(&amp;S)</translation>
    </message>
    <message>
        <source>Arrows from expected to measured corners, magnified</source>
        <translation>从预期到测得角点的箭头，已放大</translation>
    </message>
</context>
<context>
    <name>LensModelsPanel</name>
    <message>
        <source>Lens models</source>
        <translation>镜头模型</translation>
    </message>
    <message>
        <source>All lens models on the same corners, by what they predict of unseen views.</source>
        <translation>所有镜头模型用相同角点，按其对未见视图的预测排列。</translation>
    </message>
    <message>
        <source>C&amp;ompare lens models</source>
        <translation>比较镜头模型(&amp;O)</translation>
    </message>
    <message>
        <source>Calibrates every lens model from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>用这些视图标定每个镜头模型，再去掉其中一些重新标定，看它对未见内容预测得如何。需要一些时间。</translation>
    </message>
    <message>
        <source>Comparing lens models</source>
        <translation>正在比较镜头模型</translation>
    </message>
    <message>
        <source>Calibrating every lens model several times…</source>
        <translation>正在多次标定每个镜头模型…</translation>
    </message>
    <message>
        <source>&amp;Use this model</source>
        <translation>使用此模型(&amp;U)</translation>
    </message>
    <message>
        <source>Set the selected lens model in the Set-up and calibrate.</source>
        <translation>在设置中选用所选镜头模型并标定。</translation>
    </message>
    <message>
        <source>The views do not determine the camera: lens models cannot be compared on them.</source>
        <translation>视图不能确定相机：无法据此比较镜头模型。</translation>
    </message>
    <message>
        <source>This result is of the lens model {0}. Does another one do better?</source>
        <translation>此结果采用镜头模型 {0}。其他模型会更好吗？</translation>
    </message>
    <message>
        <source>{0} cannot be calibrated: {1}</source>
        <translation>{0} 无法标定：{1}</translation>
    </message>
    <message>
        <source>{0}: RMS {1:.3f} px, σx {2:.3f} px and σy {3:.3f} px of {4}.</source>
        <translation>{0}：RMS {1:.3f} px，σx {2:.3f} px，σy {3:.3f} px，{4}。</translation>
    </message>
</context>
<context>
    <name>LensTables</name>
    <message>
        <source>Errors</source>
        <translation>误差</translation>
    </message>
    <message>
        <source>Image</source>
        <translation>图像</translation>
    </message>
    <message>
        <source>n</source>
        <translation>n</translation>
    </message>
    <message>
        <source>Estimated parameters</source>
        <translation>估计的参数</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>用所有视图标定的残差</translation>
    </message>
    <message>
        <source>σx</source>
        <translation>σx</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals across the image</source>
        <translation>这些残差沿图像横向的标准差</translation>
    </message>
    <message>
        <source>σy</source>
        <translation>σy</translation>
    </message>
    <message>
        <source>Standard deviation of these residuals down the image</source>
        <translation>这些残差沿图像纵向的标准差</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>未见</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>轮流排除的视图的残差 RMS，
只拟合其位姿</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>中位数</translation>
    </message>
    <message>
        <source>Median length of the residuals of unseen views</source>
        <translation>未见视图残差长度的中位数</translation>
    </message>
    <message>
        <source>95 %</source>
        <translation>95 %</translation>
    </message>
    <message>
        <source>Length that 95 % of the residuals of unseen views do not exceed</source>
        <translation>95 % 的未见视图残差不超过的长度</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>备注</translation>
    </message>
    <message>
        <source>Horizontal</source>
        <translation>水平</translation>
    </message>
    <message>
        <source>H</source>
        <translation>H</translation>
    </message>
    <message>
        <source>Vertical</source>
        <translation>垂直</translation>
    </message>
    <message>
        <source>V</source>
        <translation>V</translation>
    </message>
    <message>
        <source>Diagonal</source>
        <translation>对角</translation>
    </message>
    <message>
        <source>D</source>
        <translation>D</translation>
    </message>
    <message>
        <source>Field of view, {0}, degrees</source>
        <translation>视场，{0}，度</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>角点</translation>
    </message>
    <message>
        <source>Largest angle off the axis at which a corner was seen, degrees</source>
        <translation>见到角点的最大离轴角，度</translation>
    </message>
    <message>
        <source>BIC</source>
        <translation>BIC</translation>
    </message>
    <message>
        <source>Bayesian information criterion, less the least one</source>
        <translation>贝叶斯信息准则，减去最小值</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>相差</translation>
    </message>
    <message>
        <source>Largest distance from the recommended model&apos;s map where corners were seen</source>
        <translation>在见到角点之处与推荐模型映射的最大距离</translation>
    </message>
    <message>
        <source>Valid</source>
        <translation>有效</translation>
    </message>
    <message>
        <source>Part of the image on which the map is one-to-one</source>
        <translation>映射一一对应的图像部分</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>镜头模型</translation>
    </message>
</context>
<context>
    <name>LimitsChoice</name>
    <message>
        <source>Limits</source>
        <translation>限值</translation>
    </message>
    <message>
        <source>What a calibration has to keep, as for a fleet: the verdict stays as it is.</source>
        <translation>标定必须满足的要求，与机群相同：结论不变。</translation>
    </message>
    <message>
        <source>nothing is demanded</source>
        <translation>没有要求</translation>
    </message>
    <message>
        <source>from a file…</source>
        <translation>来自文件…</translation>
    </message>
    <message>
        <source>With limits the verdict says PASS or FAIL, as for a fleet&apos;s cameras.</source>
        <translation>设定限值后，结论会给出 PASS 或 FAIL，与批量相机相同。</translation>
    </message>
    <message>
        <source>Limits (*.toml)</source>
        <translation>限值 (*.toml)</translation>
    </message>
    <message>
        <source>error of a pixel at the edge: at most {0:g} px</source>
        <translation>边缘像素误差：最多 {0:g} px</translation>
    </message>
    <message>
        <source>photographs: at least {0:g}</source>
        <translation>照片：至少 {0:g} 张</translation>
    </message>
    <message>
        <source>of the sensor with corners: at least {0:g} %</source>
        <translation>有角点的传感器部分：至少 {0:g} %</translation>
    </message>
    <message>
        <source>lengths of {0:g} mm at {1:g} mm: ± {2:g} mm at most</source>
        <translation>{1:g} mm 处 {0:g} mm 的长度：最多 ± {2:g} mm</translation>
    </message>
</context>
<context>
    <name>LimitsRow</name>
    <message>
        <source>Limits</source>
        <translation>限值</translation>
    </message>
    <message>
        <source>FAIL by the limits {0}. {1}</source>
        <translation>按限值 {0} 为 FAIL。{1}</translation>
    </message>
    <message>
        <source>PASS by the limits {0}.</source>
        <translation>按限值 {0} 为 PASS。</translation>
    </message>
</context>
<context>
    <name>LivePage</name>
    <message>
        <source>Choose a camera, and press Start.</source>
        <translation>选择相机，然后按“开始”。</translation>
    </message>
    <message>
        <source>as the camera has it</source>
        <translation>保持相机的设置</translation>
    </message>
    <message>
        <source>{0} × {1} px</source>
        <translation>{0} × {1} px</translation>
    </message>
    <message>
        <source>Exposure, the same in all pictures</source>
        <translation>曝光，所有照片相同</translation>
    </message>
    <message>
        <source>Focus, the same in all pictures</source>
        <translation>对焦，所有照片相同</translation>
    </message>
    <message>
        <source>{0}, in the camera&apos;s own unit, of a camera at this computer</source>
        <translation>{0}，以相机自己的单位，用于本机的相机</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>It ends when the camera puts no pixel farther off, one standard deviation</source>
        <translation>当相机没有像素偏离更多时结束，一个标准差</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>选择…</translation>
    </message>
    <message>
        <source>A &amp;sound for each picture</source>
        <translation>每张照片响一声(&amp;S)</translation>
    </message>
    <message>
        <source>&amp;Start</source>
        <translation>开始(&amp;S)</translation>
    </message>
    <message>
        <source>&amp;Take it now (space)</source>
        <translation>立即拍摄 (空格)(&amp;T)</translation>
    </message>
    <message>
        <source>&amp;Finish</source>
        <translation>结束(&amp;F)</translation>
    </message>
    <message>
        <source>&amp;Calibrate with these</source>
        <translation>用这些标定(&amp;C)</translation>
    </message>
    <message>
        <source>&amp;Go on</source>
        <translation>继续(&amp;G)</translation>
    </message>
    <message>
        <source>&amp;Leave</source>
        <translation>离开(&amp;L)</translation>
    </message>
    <message>
        <source>%p % of the way to the yellow place</source>
        <translation>到黄色位置的 %p %</translation>
    </message>
    <message>
        <source>as it is</source>
        <translation>不变</translation>
    </message>
    <message>
        <source>Camera, address or folder</source>
        <translation>相机、地址或文件夹</translation>
    </message>
    <message>
        <source>Size of its images</source>
        <translation>图像尺寸</translation>
    </message>
    <message>
        <source>Exposure</source>
        <translation>曝光</translation>
    </message>
    <message>
        <source>Focus</source>
        <translation>对焦</translation>
    </message>
    <message>
        <source>Until the worst pixel is known to</source>
        <translation>直到最差像素已知到</translation>
    </message>
    <message>
        <source>Pictures are written to</source>
        <translation>照片写入</translation>
    </message>
    <message>
        <source>Hold the whole board in the picture: its kind and size are found. The yellow shape shows where it is wanted next. When it is still, sharp and worth it, the picture is taken by itself; every fifth one is put aside to check the camera with. No board at hand? Calibration › Print a board shows one on a screen.</source>
        <translation>把整块标定板放在画面中：种类和大小会自动识别。黄色形状表示下一步放在哪里。当它静止、清晰且有价值时，照片会自动拍下；每五张留出一张用于检查相机。手边没有标定板？“标定 › 打印标定板”可在屏幕上显示一块。</translation>
    </message>
    <message>
        <source>Photograph live</source>
        <translation>实时拍摄</translation>
    </message>
    <message>
        <source>Opening…</source>
        <translation>正在打开…</translation>
    </message>
    <message>
        <source>Pictures put aside are predicted to {0} px rms ({1} corners).</source>
        <translation>留出的照片预测到 {0} px 均方根（{1} 个角点）。</translation>
    </message>
    <message>
        <source>Nothing was taken.</source>
        <translation>没有拍摄任何照片。</translation>
    </message>
    <message>
        <source>Done: known well enough.</source>
        <translation>完成：已足够精确。</translation>
    </message>
    <message>
        <source>Stopped. More pictures would help.</source>
        <translation>已停止。更多照片会有帮助。</translation>
    </message>
    <message>
        <source>Folder for the pictures</source>
        <translation>照片的文件夹</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Live image</source>
        <translation>实时图像</translation>
    </message>
</context>
<context>
    <name>LiveViews</name>
    <message>
        <source>Live image</source>
        <translation type="unfinished">实时图像</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>C&amp;alibrate</source>
        <translation>标定(&amp;A)</translation>
    </message>
    <message>
        <source>Find the corners still missing, then estimate the camera</source>
        <translation>找到仍缺的角点，然后估计相机</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>设置</translation>
    </message>
    <message>
        <source>The program has met an error again: {0}.</source>
        <translation>程序再次遇到错误：{0}。</translation>
    </message>
    <message>
        <source>Save the project, and start the program anew.</source>
        <translation>请保存项目并重新启动程序。</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>未命名</translation>
    </message>
</context>
<context>
    <name>ManualDialog</name>
    <message>
        <source>Manual</source>
        <translation>手册</translation>
    </message>
    <message>
        <source>Chapters</source>
        <translation>章节</translation>
    </message>
    <message>
        <source>Chapter</source>
        <translation>章</translation>
    </message>
    <message>
        <source>Open in the &amp;browser</source>
        <translation>在浏览器中打开(&amp;B)</translation>
    </message>
    <message>
        <source>All chapters as one page, to search and to print</source>
        <translation>所有章节在一页，便于搜索和打印</translation>
    </message>
</context>
<context>
    <name>ManyCameras</name>
    <message>
        <source>Open fleet</source>
        <translation>打开机群</translation>
    </message>
    <message>
        <source>Fleets (*.db)</source>
        <translation>机群 (*.db)</translation>
    </message>
    <message>
        <source>Reading {0}</source>
        <translation>正在读取 {0}</translation>
    </message>
</context>
<context>
    <name>Marker</name>
    <message>
        <source>Turn axes</source>
        <translation>旋转坐标轴</translation>
    </message>
    <message>
        <source>Flip axes</source>
        <translation>翻转坐标轴</translation>
    </message>
    <message>
        <source>Click the four outermost {1}, going round the board: {0} of 4.</source>
        <translation>请绕标定板依次点击最外侧的四个{1}：{0} / 4。</translation>
    </message>
    <message>
        <source> Backspace takes one back.</source>
        <translation> 退格键撤回一个。</translation>
    </message>
    <message>
        <source>Counting…</source>
        <translation>正在计数…</translation>
    </message>
    <message>
        <source>{0} of {1} corners. Enter accepts; drag a handle to change them.</source>
        <translation>{1} 个角点中的 {0} 个。回车接受；拖动手柄可更改。</translation>
    </message>
    <message>
        <source> The other images show {0} × {1}.</source>
        <translation> 其他图像显示 {0} × {1}。</translation>
    </message>
    <message>
        <source>This image has {0} × {1} pixels, the others {2} × {3}.</source>
        <translation>此图像为 {0} × {1} 像素，其他为 {2} × {3}。</translation>
    </message>
    <message>
        <source>Calibrate images of each size by themselves.</source>
        <translation>请分别标定每种尺寸的图像。</translation>
    </message>
    <message>
        <source>Mark board</source>
        <translation>标记标定板</translation>
    </message>
    <message>
        <source>Move corner</source>
        <translation>移动角点</translation>
    </message>
    <message>
        <source>Remove corner</source>
        <translation>删除角点</translation>
    </message>
    <message>
        <source>Restore corner</source>
        <translation>恢复角点</translation>
    </message>
</context>
<context>
    <name>Matrix</name>
    <message>
        <source>correlation of {0} and {1}: {2:+.4f}</source>
        <translation>{0} 与 {1} 的相关系数：{2:+.4f}</translation>
    </message>
</context>
<context>
    <name>MethodChoice</name>
    <message>
        <source>Method</source>
        <translation>方法</translation>
    </message>
</context>
<context>
    <name>MethodTables</name>
    <message>
        <source>Errors</source>
        <translation>误差</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>It knows no lengths: this is the distance of corners from straight rows and columns.
Compare it with methods marked * only.</source>
        <translation>它不知道长度：这是角点到直行和直列的距离。
只与带 * 的方法比较。</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source>Residuals of a calibration from all views</source>
        <translation>用所有视图标定的残差</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate of these residuals</source>
        <translation>这些残差一个坐标的标准差</translation>
    </message>
    <message>
        <source>Unseen</source>
        <translation>未见</translation>
    </message>
    <message>
        <source>RMS of the residuals of views that were left out of the calibration in turn,
with only their poses fitted</source>
        <translation>轮流排除的视图的残差 RMS，
只拟合其位姿</translation>
    </message>
    <message>
        <source>Differs</source>
        <translation>相差</translation>
    </message>
    <message>
        <source>Largest distance between a point&apos;s images by this method and by the chosen
calibration, where corners were seen</source>
        <translation>在见到角点之处，此方法与所选标定
对同一点成像的最大距离</translation>
    </message>
    <message>
        <source>in RMS</source>
        <translation>按 RMS</translation>
    </message>
    <message>
        <source>Root mean square of these distances</source>
        <translation>这些距离的均方根</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>步数</translation>
    </message>
    <message>
        <source>Iterations of the refinement; a dash where there are none, or not told</source>
        <translation>优化的迭代次数；没有或未告知处为短横线</translation>
    </message>
    <message>
        <source>Time [s]</source>
        <translation>时间 [s]</translation>
    </message>
    <message>
        <source>Time of initialisation and refinement from all views</source>
        <translation>用所有视图初始化和优化的时间</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>时间</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>备注</translation>
    </message>
    <message>
        <source>Principal point; of methods marked * the distortion&apos;s centre</source>
        <translation>主点；带 * 的方法为畸变中心</translation>
    </message>
    <message>
        <source>Focal length across the image</source>
        <translation>图像横向的焦距</translation>
    </message>
    <message>
        <source>Focal length down the image</source>
        <translation>图像纵向的焦距</translation>
    </message>
    <message>
        <source>Shift across the image over a length of fy down it</source>
        <translation>纵向 fy 长度上的横向偏移</translation>
    </message>
    <message>
        <source>How far the distortion moves points that are measured {0:.0f} px from the centre,
where the outermost corner lies; negative towards it</source>
        <translation>畸变把测得距中心 {0:.0f} px 的点移动多少，
最外侧角点在那里；负值为朝向中心</translation>
    </message>
    <message>
        <source>Shift</source>
        <translation>偏移</translation>
    </message>
    <message>
        <source>Coefficients</source>
        <translation>系数</translation>
    </message>
    <message>
        <source>{0} ± {1:.2g} px (1σ)</source>
        <translation>{0} ± {1:.2g} px (1σ)</translation>
    </message>
    <message>
        <source>It does not estimate this. {0}</source>
        <translation>它不估计此项。{0}</translation>
    </message>
    <message>
        <source>One standard deviation of {0}</source>
        <translation>{0} 的一个标准差</translation>
    </message>
    <message>
        <source>σ of {0}</source>
        <translation>{0} 的 σ</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>方法</translation>
    </message>
</context>
<context>
    <name>MethodsPanel</name>
    <message>
        <source>Methods</source>
        <translation>方法</translation>
    </message>
    <message>
        <source>All methods of calibration on the same corners.</source>
        <translation>所有标定方法用相同角点。</translation>
    </message>
    <message>
        <source>C&amp;ompare methods</source>
        <translation>比较方法(&amp;O)</translation>
    </message>
    <message>
        <source>Calibrates with every method from these views, and again without some of them, to see how well it predicts what it has not seen. Takes a while.</source>
        <translation>用这些视图以每种方法标定，再去掉其中一些重新标定，看它对未见内容预测得如何。需要一些时间。</translation>
    </message>
    <message>
        <source>Comparing methods</source>
        <translation>正在比较方法</translation>
    </message>
    <message>
        <source>Calibrating with every method several times…</source>
        <translation>正在用每种方法多次标定…</translation>
    </message>
    <message>
        <source>&amp;Use this method</source>
        <translation>使用此方法(&amp;U)</translation>
    </message>
    <message>
        <source>About the method</source>
        <translation>关于此方法</translation>
    </message>
    <message>
        <source>Map</source>
        <translation>分布图</translation>
    </message>
    <message>
        <source>About</source>
        <translation>关于</translation>
    </message>
    <message>
        <source>The views do not determine the camera: methods cannot be compared on them.</source>
        <translation>视图不能确定相机：无法据此比较方法。</translation>
    </message>
    <message>
        <source>This result is by the method “{0}”. What would others make of it?</source>
        <translation>此结果采用方法“{0}”。其他方法会得到什么？</translation>
    </message>
    <message>
        <source>Each RMS and σ is of {0:,} corners in {1} views.</source>
        <translation>每个 RMS 和 σ 均来自 {1} 个视图中的 {0:,} 个角点。</translation>
    </message>
    <message>
        <source>Differences are from the calibration that was shown when they were found.</source>
        <translation>差异是相对于得出它们时所显示的标定。</translation>
    </message>
    <message>
        <source>Set the selected method in the Set-up and calibrate.</source>
        <translation>在设置中选用所选方法并标定。</translation>
    </message>
    <message>
        <source>It gives no camera from these views: {0}</source>
        <translation>它从这些视图得不到相机：{0}</translation>
    </message>
    <message>
        <source>It knows no lengths, and so gives no camera: only the distortion.</source>
        <translation>它不知道长度，因此不给出相机：只有畸变。</translation>
    </message>
    <message>
        <source>Its coefficients: {0}.</source>
        <translation>它的系数：{0}。</translation>
    </message>
    <message>
        <source>Source: {0}</source>
        <translation>来源：{0}</translation>
    </message>
</context>
<context>
    <name>ModeBar</name>
    <message>
        <source>What the desk shows</source>
        <translation>桌面显示的内容</translation>
    </message>
</context>
<context>
    <name>Offers</name>
    <message>
        <source>&amp;All {0} images</source>
        <translation>全部 {0} 幅图像(&amp;A)</translation>
    </message>
    <message>
        <source>A report tells how a camera was calibrated, and this one is known from a file. Calibrate it from these photographs?</source>
        <translation>报告说明相机是如何标定的，而这台相机来自文件。用这些照片标定它吗？</translation>
    </message>
    <message>
        <source>C&amp;alibrate it</source>
        <translation>标定(&amp;A)</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation type="unfinished">重新标定</translation>
    </message>
    <message>
        <source>Open {0}</source>
        <translation>打开 {0}</translation>
    </message>
    <message>
        <source>The program ended without saving {0}. Its state of {1} has been kept. The project was saved {2}.</source>
        <translation>程序结束时没有保存 {0}。其 {1} 的状态已保留。项目保存于 {2}。</translation>
    </message>
    <message>
        <source>The program ended without saving a project of {0} photographs in {1}, which had no name yet. Its state of {2} has been kept.</source>
        <translation>程序结束时没有保存 {1} 中含 {0} 张照片的未命名项目。其 {2} 的状态已保留。</translation>
    </message>
    <message>
        <source>The program ended without saving a project that had no name yet. Its state of {0} has been kept.</source>
        <translation>程序结束时没有保存一个未命名项目。其 {0} 的状态已保留。</translation>
    </message>
    <message>
        <source>&amp;Recover</source>
        <translation>恢复(&amp;R)</translation>
    </message>
    <message>
        <source>Go on &amp;without</source>
        <translation>不恢复，继续(&amp;W)</translation>
    </message>
    <message>
        <source>The unsaved state is kept for a while, as {0}.</source>
        <translation>未保存的状态会保留一段时间，为 {0}。</translation>
    </message>
    <message>
        <source>&amp;Bring it back</source>
        <translation>取回(&amp;B)</translation>
    </message>
    <message>
        <source>{0} of {1} images changed since their corners were found, among them {2}.</source>
        <translation>{1} 幅图像中有 {0} 幅在找到角点之后已更改，其中有 {2}。</translation>
    </message>
    <message>
        <source>&amp;Detect again</source>
        <translation>重新检测(&amp;D)</translation>
    </message>
    <message>
        <source>{0} of {1} images are not where they were, among them {2}.</source>
        <translation>{1} 幅图像中有 {0} 幅不在原处，其中有 {2}。</translation>
    </message>
    <message>
        <source>{0} of {1} images are at addresses, among them {2}. Download them, and locate the copies.</source>
        <translation>{1} 幅图像中有 {0} 幅在网络地址上，其中有 {2}。请下载并定位副本。</translation>
    </message>
    <message>
        <source>&amp;Locate…</source>
        <translation>定位(&amp;L)…</translation>
    </message>
    <message>
        <source>Looking for another kind of board</source>
        <translation>正在寻找另一种标定板</translation>
    </message>
    <message>
        <source>The photographs are mirrored, so that the marks on the board cannot be read. Turn mirroring off in the camera or in its program, and take them again.</source>
        <translation>照片是镜像的，板上的标记无法读取。请在相机或其程序中关闭镜像并重新拍摄。</translation>
    </message>
    <message>
        <source>A board of {0} × {1} inner corners is in no image; the images show {2} × {3}.</source>
        <translation>没有图像含 {0} × {1} 内角点的标定板；图像显示 {2} × {3}。</translation>
    </message>
    <message>
        <source>&amp;Search for {0} × {1}</source>
        <translation>搜索 {0} × {1}(&amp;S)</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>角点数</translation>
    </message>
    <message>
        <source>Pattern</source>
        <translation>图案</translation>
    </message>
</context>
<context>
    <name>OnDemandPanel</name>
    <message>
        <source>What was found</source>
        <translation>找到的内容</translation>
    </message>
</context>
<context>
    <name>OwnPages</name>
    <message>
        <source>Several cameras</source>
        <translation type="unfinished">多台相机</translation>
    </message>
    <message>
        <source>Are these the photographs of several cameras that stand fast to each other, a folder or a video for each? No: all are of one camera.</source>
        <translation>这些照片是否来自多台相对固定的相机，每台相机一个文件夹或一段视频？否：全部来自同一台相机。</translation>
    </message>
</context>
<context>
    <name>PairingMatrix</name>
    <message>
        <source>Photographs by cameras and instants</source>
        <translation>按相机和时刻排列的照片</translation>
    </message>
    <message>
        <source>A column for each camera, a row for each instant. Click a camera&apos;s name to choose all its photographs.</source>
        <translation>每台相机一列，每个时刻一行。点击相机名称可选中其所有照片。</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>已排除</translation>
    </message>
    <message>
        <source>{0}: contradicts the others</source>
        <translation>{0}：与其他矛盾</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>{0}: {1} corners, {2} px rms; alone {3} px</source>
        <translation>{0}：{1} 个角点，{2} px 均方根；单独 {3} px</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>无标定板</translation>
    </message>
</context>
<context>
    <name>PairingPane</name>
    <message>
        <source>Earli&amp;er</source>
        <translation type="unfinished">更早(&amp;E)</translation>
    </message>
    <message>
        <source>La&amp;ter</source>
        <translation type="unfinished">更晚(&amp;T)</translation>
    </message>
    <message>
        <source>Lea&amp;ve out</source>
        <translation type="unfinished">排除(&amp;V)</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation type="unfinished">撤销(&amp;U)</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant before</source>
        <translation type="unfinished">把所选相机照片移到前一时刻</translation>
    </message>
    <message>
        <source>Move the chosen photographs of a camera to the instant after</source>
        <translation type="unfinished">把所选相机照片移到后一时刻</translation>
    </message>
</context>
<context>
    <name>Palette</name>
    <message>
        <source>Find an action</source>
        <translation>查找操作</translation>
    </message>
    <message>
        <source>Type a part of what you want to do</source>
        <translation>键入您想做的事的一部分</translation>
    </message>
    <message>
        <source>Part of an action&apos;s name</source>
        <translation>操作名称的一部分</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>清除</translation>
    </message>
    <message>
        <source>Actions</source>
        <translation>操作</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>操作</translation>
    </message>
    <message>
        <source>Menu</source>
        <translation>菜单</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>按键</translation>
    </message>
    <message>
        <source>No action of the menus is called so.</source>
        <translation>菜单中没有这样的操作。</translation>
    </message>
</context>
<context>
    <name>Panel</name>
    <message>
        <source>Nothing is calibrated yet. What Calibrate finds is shown here.</source>
        <translation>还没有标定。“标定”的结果在此显示。</translation>
    </message>
</context>
<context>
    <name>ParameterTable</name>
    <message>
        <source>Parameter</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Real</source>
        <translation>真实</translation>
    </message>
    <message>
        <source>Synthetic</source>
        <translation>合成</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>差异</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>以 σ 计</translation>
    </message>
    <message>
        <source>The difference over the synthetic result&apos;s standard deviation.</source>
        <translation>差异除以合成结果的标准差。</translation>
    </message>
</context>
<context>
    <name>PatternChoice</name>
    <message>
        <source>Pattern</source>
        <translation>图案</translation>
    </message>
    <message>
        <source>What is printed on the board.</source>
        <translation>标定板上印的图案。</translation>
    </message>
    <message>
        <source>The set of markers on the board, by OpenCV&apos;s name.</source>
        <translation>板上标记的集合，按 OpenCV 的名称。</translation>
    </message>
    <message>
        <source>Boards with an even number of rows of squares changed with OpenCV 4.6.</source>
        <translation>方格行数为偶数的板在 OpenCV 4.6 中有变化。</translation>
    </message>
    <message>
        <source>first square dark</source>
        <translation>第一个方格为深色</translation>
    </message>
    <message>
        <source>as before OpenCV 4.6</source>
        <translation>与 OpenCV 4.6 之前相同</translation>
    </message>
    <message>
        <source>A table (CSV) of the circles&apos; x and y in mm, or the same as JSON.</source>
        <translation>圆的 x 和 y（mm）的表格 (CSV)，或相同内容的 JSON。</translation>
    </message>
    <message>
        <source>The family of the AprilTags on the board.</source>
        <translation>板上 AprilTag 的家族。</translation>
    </message>
    <message>
        <source>The gap between tags over the side of a tag, at most 1: Kalibr&apos;s tagSpacing.</source>
        <translation>标签间隙与标签边长之比，最大 1：即 Kalibr 的 tagSpacing。</translation>
    </message>
    <message>
        <source>The width of a tag&apos;s black border; 2 cells on Kalibr&apos;s.</source>
        <translation>标签黑边的宽度；Kalibr 为 2 格。</translation>
    </message>
    <message>
        <source>2 cells</source>
        <translation>2 格</translation>
    </message>
    <message>
        <source>1 cell</source>
        <translation>1 格</translation>
    </message>
    <message>
        <source>The row of tags that holds the lowest numbers.</source>
        <translation>编号最小的标签行。</translation>
    </message>
    <message>
        <source>from the bottom, as Kalibr</source>
        <translation>自下而上，同 Kalibr</translation>
    </message>
    <message>
        <source>from the top</source>
        <translation>自上而下</translation>
    </message>
    <message>
        <source>Small dark squares between the corners of the tags, as on Kalibr&apos;s.</source>
        <translation>标签角之间的深色小方格，同 Kalibr。</translation>
    </message>
    <message>
        <source>between the tags</source>
        <translation>在标签之间</translation>
    </message>
    <message>
        <source>none</source>
        <translation>无</translation>
    </message>
    <message>
        <source>The number of squares from one tag to the next in its row.</source>
        <translation>同一行中相邻标签之间的方格数。</translation>
    </message>
    <message>
        <source>Row of the first corner</source>
        <translation>第一个角点的行</translation>
    </message>
    <message>
        <source>Column of the first corner</source>
        <translation>第一个角点的列</translation>
    </message>
    <message>
        <source>Row and column of the board&apos;s first corner on the whole PuzzleBoard pattern.</source>
        <translation>板的第一个角点在整个 PuzzleBoard 图案中的行和列。</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>内角点</translation>
    </message>
    <message>
        <source>Small squares</source>
        <translation>小方格</translation>
    </message>
    <message>
        <source>List</source>
        <translation>列表</translation>
    </message>
    <message>
        <source>Dictionary</source>
        <translation>字典</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>标记</translation>
    </message>
    <message>
        <source>Layout</source>
        <translation>布局</translation>
    </message>
    <message>
        <source>Diameter</source>
        <translation>直径</translation>
    </message>
    <message>
        <source>Tag family</source>
        <translation>标签家族</translation>
    </message>
    <message>
        <source>Gap / side</source>
        <translation>间隙 / 边长</translation>
    </message>
    <message>
        <source>Tag border</source>
        <translation>标签边框</translation>
    </message>
    <message>
        <source>Tag step</source>
        <translation>标签步距</translation>
    </message>
    <message>
        <source>Numbered</source>
        <translation>编号</translation>
    </message>
    <message>
        <source>First marker</source>
        <translation>首个标记</translation>
    </message>
    <message>
        <source>First tag</source>
        <translation>首个标签</translation>
    </message>
    <message>
        <source>First corner</source>
        <translation>首个角点</translation>
    </message>
    <message>
        <source>The lowest number of a marker or tag on the board: 0 on most.</source>
        <translation>标定板上标记或标签的最小编号:多数为 0。</translation>
    </message>
    <message>
        <source>Choose a file…</source>
        <translation>选择文件…</translation>
    </message>
    <message>
        <source>{0} circles…</source>
        <translation>{0} 个圆…</translation>
    </message>
    <message>
        <source>List of circles</source>
        <translation>圆的列表</translation>
    </message>
    <message>
        <source>Lists of circles (*.csv *.json)</source>
        <translation>圆的列表 (*.csv *.json)</translation>
    </message>
</context>
<context>
    <name>PatternTexts</name>
    <message>
        <source>Checkerboard</source>
        <translation>棋盘格</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard.</source>
        <translation>这些看起来是棋盘格的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard</source>
        <translation>搜索棋盘格(&amp;S)</translation>
    </message>
    <message>
        <source>ChArUco board</source>
        <translation>ChArUco 板</translation>
    </message>
    <message>
        <source>These look like photographs of a ChArUco board.</source>
        <translation>这些看起来是 ChArUco 板的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for a ChArUco board</source>
        <translation>搜索 ChArUco 板(&amp;S)</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>圆点</translation>
    </message>
    <message>
        <source>These look like photographs of a grid of circles.</source>
        <translation>这些看起来是圆点阵列的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for circles</source>
        <translation>搜索圆点(&amp;S)</translation>
    </message>
    <message>
        <source>Asymmetric circles</source>
        <translation>非对称圆点</translation>
    </message>
    <message>
        <source>These look like photographs of an asymmetric grid of circles.</source>
        <translation>这些看起来是非对称圆点阵列的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for asymmetric circles</source>
        <translation>搜索非对称圆点(&amp;S)</translation>
    </message>
    <message>
        <source>Circles of a list</source>
        <translation>列表中的圆</translation>
    </message>
    <message>
        <source>These look like photographs of listed circles.</source>
        <translation>这些看起来是列表中圆的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for listed circles</source>
        <translation>搜索列表中的圆(&amp;S)</translation>
    </message>
    <message>
        <source>AprilGrid</source>
        <translation>AprilGrid</translation>
    </message>
    <message>
        <source>These look like photographs of an AprilGrid.</source>
        <translation>这些看起来是 AprilGrid 的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for an AprilGrid</source>
        <translation>搜索 AprilGrid(&amp;S)</translation>
    </message>
    <message>
        <source>Checkerboard with tags</source>
        <translation>带标签的棋盘格</translation>
    </message>
    <message>
        <source>These look like photographs of a checkerboard with AprilTags.</source>
        <translation>这些看起来是带 AprilTag 的棋盘格的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for a checkerboard with tags</source>
        <translation>搜索带标签的棋盘格(&amp;S)</translation>
    </message>
    <message>
        <source>PuzzleBoard</source>
        <translation>PuzzleBoard</translation>
    </message>
    <message>
        <source>These look like photographs of a PuzzleBoard.</source>
        <translation>这些看起来是 PuzzleBoard 的照片。</translation>
    </message>
    <message>
        <source>&amp;Search for a PuzzleBoard</source>
        <translation>搜索 PuzzleBoard(&amp;S)</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation>角点</translation>
    </message>
    <message>
        <source>Inner corners</source>
        <translation>内角点</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation type="unfinished">间距</translation>
    </message>
    <message>
        <source>Tag</source>
        <translation type="unfinished">标签</translation>
    </message>
    <message>
        <source>Square</source>
        <translation type="unfinished">方格</translation>
    </message>
</context>
<context>
    <name>PlaneChoice</name>
    <message>
        <source>in the image</source>
        <translation>在图像中</translation>
    </message>
    <message>
        <source>on the reference plane</source>
        <translation>在参考平面上</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>参考 px</translation>
    </message>
    <message>
        <source>In the image a residual is the measured less the predicted corner.
The paper&apos;s reference plane has 30 px to a square; residuals of far and tilted
boards look larger there (figures 10 to 12).</source>
        <translation>在图像中，残差是测得角点减预测角点。
论文的参考平面每个方格 30 px；远而倾斜的板
在那里残差看起来更大（图 10 到 12）。</translation>
    </message>
    <message>
        <source>Where residuals are shown</source>
        <translation>残差显示在何处</translation>
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
        <translation>显示全部</translation>
    </message>
    <message>
        <source>Copy as image</source>
        <translation>复制为图像</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>保存图表…</translation>
    </message>
</context>
<context>
    <name>PoseErrors</name>
    <message>
        <source>relative error of an external parameter</source>
        <translation>外参数的相对误差</translation>
    </message>
    <message>
        <source>count</source>
        <translation>数量</translation>
    </message>
    <message>
        <source>|z real − z synthetic| / |z real| of eq. 51 (figure 14).</source>
        <translation>式 51 的 |z 真实 − z 合成| / |z 真实|（图 14）。</translation>
    </message>
    <message>
        <source>median {0:.3g} %, largest {1:.3g} %</source>
        <translation>中位数 {0:.3g} %，最大 {1:.3g} %</translation>
    </message>
</context>
<context>
    <name>PosesPanel</name>
    <message>
        <source>Poses</source>
        <translation>位姿</translation>
    </message>
    <message>
        <source>Where the board was held before the camera, in space: the extrinsics.</source>
        <translation>标定板在相机前的空间位置：外参数。</translation>
    </message>
    <message>
        <source>Camera at rest</source>
        <translation>相机静止</translation>
    </message>
    <message>
        <source>Board at rest</source>
        <translation>标定板静止</translation>
    </message>
    <message>
        <source>What stands still in the picture: the camera, with the boards around it, or the board, with the cameras around it.</source>
        <translation>图中静止的是什么：相机，板在其周围；或标定板，相机在其周围。</translation>
    </message>
    <message>
        <source>What stands still</source>
        <translation>静止的是</translation>
    </message>
    <message>
        <source>&amp;Reset view</source>
        <translation>重置视角(&amp;R)</translation>
    </message>
    <message>
        <source>Show everything, from where it was seen first</source>
        <translation>显示全部，从最初的视角</translation>
    </message>
    <message>
        <source>Drag to turn, wheel to zoom, click a board or camera to see its image.</source>
        <translation>拖动旋转，滚轮缩放，点击板或相机查看其图像。</translation>
    </message>
    <message>
        <source>Camera and boards in space</source>
        <translation>空间中的相机和标定板</translation>
    </message>
    <message>
        <source>{0}: {1:.0f} mm away{2}, tilted by {3:.0f}°</source>
        <translation>{0}：距离 {1:.0f} mm{2}，倾斜 {3:.0f}°</translation>
    </message>
    <message>
        <source>{0} views, {1:.0f} to {2:.0f} mm away{3}, tilted by {4:.0f}° to {5:.0f}°</source>
        <translation>{0} 个视图，距离 {1:.0f} 到 {2:.0f} mm{3}，倾斜 {4:.0f}° 到 {5:.0f}°</translation>
    </message>
</context>
<context>
    <name>Preparation</name>
    <message>
        <source>Compiling for speed, once</source>
        <translation type="unfinished">正在编译以提速，仅此一次</translation>
    </message>
</context>
<context>
    <name>PrintDialog</name>
    <message>
        <source>Board to print</source>
        <translation>要打印的标定板</translation>
    </message>
    <message>
        <source>usual</source>
        <translation>常用</translation>
    </message>
    <message>
        <source>Rows</source>
        <translation>行</translation>
    </message>
    <message>
        <source>Columns</source>
        <translation>列</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>&amp;Paper</source>
        <translation>纸张(&amp;P)</translation>
    </message>
    <message>
        <source>An odd and an even number of squares
lets every view find the same origin.</source>
        <translation>方格数一奇一偶
使每个视图找到相同的原点。</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>保存(&amp;S)…</translation>
    </message>
    <message>
        <source>Show on this scr&amp;een</source>
        <translation>在此屏幕上显示(&amp;E)</translation>
    </message>
    <message>
        <source>As large as the screen holds it: a screen is flat, and needs no printer</source>
        <translation>按屏幕能容纳的大小：屏幕是平的，无需打印机</translation>
    </message>
    <message>
        <source>Tags</source>
        <translation>标签</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>标签边长</translation>
    </message>
    <message>
        <source>Squares</source>
        <translation>方格</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>方格边长</translation>
    </message>
    <message>
        <source>Circles</source>
        <translation>圆点</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>间距</translation>
    </message>
    <message>
        <source>Fits. Print it without scaling.</source>
        <translation>放得下。请不要缩放打印。</translation>
    </message>
    <message>
        <source>Save board</source>
        <translation>保存标定板</translation>
    </message>
    <message>
        <source>PDF (*.pdf);;SVG drawing (*.svg);;PNG image (*.png)</source>
        <translation>PDF (*.pdf);;SVG 图 (*.svg);;PNG 图像 (*.png)</translation>
    </message>
</context>
<context>
    <name>Progress</name>
    <message>
        <source>Stop this; what is finished stays (Shift+F9)</source>
        <translation>停止此项；已完成的保留 (Shift+F9)</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Stopping…</source>
        <translation>正在停止…</translation>
    </message>
    <message>
        <source>: {0} of {1}</source>
        <translation>：{0} / {1}</translation>
    </message>
    <message>
        <source>, {0} left</source>
        <translation>，还剩 {0}</translation>
    </message>
</context>
<context>
    <name>ProgressFigure</name>
    <message>
        <source>How far the capture has come</source>
        <translation>拍摄进展</translation>
    </message>
    <message>
        <source>The ring: the uncertainty of the worst pixel, one standard deviation, and the one that is asked for.
The rectangle: the corners in all pictures, over the sensor.
The circle: how the boards were tilted; the middle is facing the camera, the rim 60 degrees.</source>
        <translation>圆环：最差像素的不确定度（一个标准差）及所要求的值。
矩形：所有照片的角点，在传感器上。
圆：标定板的倾斜；中心为正对相机，边缘为 60 度。</translation>
    </message>
    <message>
        <source>nothing taken</source>
        <translation>没有拍摄</translation>
    </message>
    <message>
        <source>{0} taken, not determined yet</source>
        <translation>已拍 {0}，尚未确定</translation>
    </message>
    <message>
        <source>{0} taken, worst pixel ±{1} px of {2}</source>
        <translation>已拍 {0}，最差像素 ±{1} px，目标 {2}</translation>
    </message>
    <message>
        <source>±{0} px</source>
        <translation>±{0} px</translation>
    </message>
    <message>
        <source>of {0} px</source>
        <translation>目标 {0} px</translation>
    </message>
    <message>
        <source>corners on the sensor</source>
        <translation>传感器上的角点</translation>
    </message>
    <message>
        <source>tilts</source>
        <translation>倾斜</translation>
    </message>
</context>
<context>
    <name>RemedyRunner</name>
    <message>
        <source>Calibration</source>
        <translation>标定</translation>
    </message>
</context>
<context>
    <name>ReportDialog</name>
    <message>
        <source>Report</source>
        <translation>报告</translation>
    </message>
    <message>
        <source>All that is known</source>
        <translation>全部已知信息</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>证书</translation>
    </message>
    <message>
        <source>After ISO/IEC 17025, 7.8.2 and 7.8.4</source>
        <translation>按 ISO/IEC 17025，7.8.2 和 7.8.4</translation>
    </message>
    <message>
        <source>Letter</source>
        <translation>Letter</translation>
    </message>
    <message>
        <source>not stated</source>
        <translation>未填写</translation>
    </message>
    <message>
        <source>&amp;Layout</source>
        <translation>版式(&amp;L)</translation>
    </message>
    <message>
        <source>Pa&amp;per</source>
        <translation>纸张(&amp;P)</translation>
    </message>
    <message>
        <source>What stands here is kept with the project. For PDF: pip install &apos;calibgui[report]&apos;.</source>
        <translation>此处内容随项目保存。要输出 PDF：pip install &apos;calibgui[report]&apos;。</translation>
    </message>
    <message>
        <source>&amp;Save…</source>
        <translation>保存(&amp;S)…</translation>
    </message>
    <message>
        <source>Number of the report</source>
        <translation>报告编号</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>操作员</translation>
    </message>
    <message>
        <source>Laboratory</source>
        <translation>实验室</translation>
    </message>
    <message>
        <source>Place of calibration</source>
        <translation>标定地点</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>温度</translation>
    </message>
    <message>
        <source>Customer</source>
        <translation>客户</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Serial number of the camera</source>
        <translation>相机序列号</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>镜头</translation>
    </message>
    <message>
        <source>Serial number of the lens</source>
        <translation>镜头序列号</translation>
    </message>
    <message>
        <source>Aperture, focus, zoom</source>
        <translation>光圈、对焦、变焦</translation>
    </message>
    <message>
        <source>Condition of the item</source>
        <translation>物品状态</translation>
    </message>
    <message>
        <source>Date of receipt</source>
        <translation>接收日期</translation>
    </message>
    <message>
        <source>Date of calibration</source>
        <translation>标定日期</translation>
    </message>
    <message>
        <source>Identification of the board</source>
        <translation>标定板标识</translation>
    </message>
    <message>
        <source>Certificate of the board</source>
        <translation>标定板证书</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>备注</translation>
    </message>
    <message>
        <source>Authorised by</source>
        <translation>批准人</translation>
    </message>
    <message>
        <source>Details of the report</source>
        <translation>报告的详情</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>正在写入 {0}</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>已保存为 {0}</translation>
    </message>
</context>
<context>
    <name>ResidualsPanel</name>
    <message>
        <source>Residuals</source>
        <translation>残差</translation>
    </message>
    <message>
        <source>Measured minus predicted corners.</source>
        <translation>测得的角点减去预测的角点。</translation>
    </message>
    <message>
        <source>Click a point to see its corner in the image.</source>
        <translation>点击一点查看其在图像中的角点。</translation>
    </message>
    <message>
        <source>{0}: mean {1:.3f}, SD {2:.3f} {3}</source>
        <translation>{0}：均值 {1:.3f}，标准差 {2:.3f} {3}</translation>
    </message>
    <message>
        <source>σ: {0} {1:.3f}, {2} {3:.3f} px</source>
        <translation>σ：{0} {1:.3f}，{2} {3:.3f} px</translation>
    </message>
    <message>
        <source>Do the residuals look like noise? Working…</source>
        <translation>残差看起来像噪声吗？正在计算…</translation>
    </message>
    <message>
        <source>Examining the residuals</source>
        <translation>正在检查残差</translation>
    </message>
    <message>
        <source>Whether the residuals look like noise was not examined.</source>
        <translation>没有检查残差是否像噪声。</translation>
    </message>
    <message>
        <source>The residuals look like noise: nothing speaks against the ± of the result.</source>
        <translation>残差看起来像噪声：没有什么与结果的 ± 相抵触。</translation>
    </message>
    <message>
        <source> Beyond {0:g} σ: {1} in {2}, each within its own uncertainty.</source>
        <translation> 超过 {0:g} σ：{2} 个中的 {1} 个，均在各自的不确定度之内。</translation>
    </message>
    <message>
        <source>The residuals are not just noise. Why is being tried.</source>
        <translation>残差不只是噪声。正在查找原因。</translation>
    </message>
    <message>
        <source>The residuals are not just noise, but no cause of it stands out that matters.</source>
        <translation>残差不只是噪声，但没有突出的重要原因。</translation>
    </message>
    <message>
        <source>The residuals are not just noise. {0} {1}</source>
        <translation>残差不只是噪声。{0} {1}</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Result</source>
        <translation>结果</translation>
    </message>
    <message>
        <source>The camera&apos;s parameters with their standard deviations, and what they are worth.</source>
        <translation>相机参数及其标准差，以及它们的可信程度。</translation>
    </message>
    <message>
        <source>Summary</source>
        <translation>摘要</translation>
    </message>
    <message>
        <source>Estimates near ±1 can stand in for each other: only a combination is known.</source>
        <translation>接近 ±1 的估计可以互相代替：只知道其组合。</translation>
    </message>
    <message>
        <source>The paper&apos;s units</source>
        <translation>论文单位</translation>
    </message>
    <message>
        <source>Correlations</source>
        <translation>相关系数</translation>
    </message>
    <message>
        <source>What this result is worth is being found out.</source>
        <translation>正在评估此结果。</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>值</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Remark</source>
        <translation>备注</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>表 2 的标准差</translation>
    </message>
    <message>
        <source>The paper&apos;s sqrt(diag((2 JᵀJ)⁻¹)), which leaves the residuals out.
1σ is what the residuals support.</source>
        <translation>论文的 sqrt(diag((2 JᵀJ)⁻¹))，不计残差大小。
1σ 是残差所支持的。</translation>
    </message>
    <message>
        <source>held</source>
        <translation>固定</translation>
    </message>
    <message>
        <source>not determined</source>
        <translation>未确定</translation>
    </message>
    <message>
        <source>assumed</source>
        <translation>假设</translation>
    </message>
    <message>
        <source>may be 0</source>
        <translation>可能为 0</translation>
    </message>
</context>
<context>
    <name>RigAnswer</name>
    <message>
        <source>Where the cameras stand</source>
        <translation>相机的位置</translation>
    </message>
    <message>
        <source>Where the boards stand</source>
        <translation>标定板位置</translation>
    </message>
    <message>
        <source>Cameras</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Points ahead</source>
        <translation>前方的点</translation>
    </message>
    <message>
        <source>The cameras agree</source>
        <translation>各相机一致</translation>
    </message>
    <message>
        <source>Photographs contradict</source>
        <translation>照片相互矛盾</translation>
    </message>
    <message>
        <source>The instants disagree</source>
        <translation>各时刻不一致</translation>
    </message>
    <message>
        <source>All lengths hold {0}.</source>
        <translation>所有长度成立 {0}。</translation>
    </message>
    <message>
        <source>camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Root mean square residual of this camera in the rig, px</source>
        <translation>此相机在相机组中的均方根残差，px</translation>
    </message>
    <message>
        <source>Number of corners</source>
        <translation>角点数</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>距离</translation>
    </message>
    <message>
        <source>± along</source>
        <translation>± 沿视线</translation>
    </message>
    <message>
        <source>Standard deviation along the line of sight, with this rig&apos;s noise, mm</source>
        <translation>沿视线的标准差，按此相机组的噪声，mm</translation>
    </message>
    <message>
        <source>± across</source>
        <translation>± 横向</translation>
    </message>
    <message>
        <source>calib.</source>
        <translation>标定</translation>
    </message>
    <message>
        <source>Part of the variance that the calibration is to blame for, %</source>
        <translation>由标定造成的方差部分，%</translation>
    </message>
    <message>
        <source>from {0}</source>
        <translation>自 {0}</translation>
    </message>
    <message>
        <source>Distance of the two cameras&apos; centres, mm</source>
        <translation>两台相机中心的距离，mm</translation>
    </message>
    <message>
        <source>turn</source>
        <translation>转角</translation>
    </message>
    <message>
        <source>Angle between the two cameras, degrees</source>
        <translation>两台相机的夹角，度</translation>
    </message>
    <message>
        <source>{0} from {1}</source>
        <translation>{0}(自 {1})</translation>
    </message>
    <message>
        <source>board</source>
        <translation>标定板</translation>
    </message>
    <message>
        <source>from board {0}</source>
        <translation>距板 {0}</translation>
    </message>
    <message>
        <source>Distance of the boards&apos; origins, mm</source>
        <translation>各板原点间距离,mm</translation>
    </message>
    <message>
        <source>Angle between the boards, degrees</source>
        <translation>各板间夹角,度</translation>
    </message>
</context>
<context>
    <name>RigForm</name>
    <message>
        <source>Shape of the boards</source>
        <translation>标定板形状</translation>
    </message>
    <message>
        <source> ms</source>
        <translation> ms</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation type="unfinished">自动</translation>
    </message>
    <message>
        <source>Photographs that were taken at most so far apart are of one instant: by their names (seconds or nanoseconds since 1970, as of ROS) or by EXIF</source>
        <translation>拍摄时间相差不超过此值的照片属于同一时刻：依据文件名（自 1970 年起的秒或纳秒，如 ROS）或 EXIF</translation>
    </message>
    <message>
        <source>Pair photographs taken within</source>
        <translation>配对拍摄间隔不超过</translation>
    </message>
    <message>
        <source>one of </source>
        <translation>每隔 </translation>
    </message>
    <message>
        <source>all</source>
        <translation type="unfinished">全部</translation>
    </message>
    <message>
        <source>Frames of videos that are taken</source>
        <translation>从视频中取用的帧</translation>
    </message>
    <message>
        <source>Leave out what no camera e&amp;xplains</source>
        <translation type="unfinished">排除没有相机能解释的(&amp;X)</translation>
    </message>
    <message>
        <source>Corners and views that no camera explains take no part</source>
        <translation type="unfinished">没有相机能解释的角点和视图不参与</translation>
    </message>
    <message>
        <source>Estimate how late each camera &amp;is</source>
        <translation>估计每台相机的延迟(&amp;I)</translation>
    </message>
    <message>
        <source>From a board that moves, in videos or in photographs that are paired by time: the clock of each camera may be late</source>
        <translation>根据移动的标定板（视频或按时间配对的照片）：每台相机的时钟可能有延迟</translation>
    </message>
    <message>
        <source>The boards are</source>
        <translation>标定板为</translation>
    </message>
    <message>
        <source>Frames of videos</source>
        <translation>视频帧</translation>
    </message>
</context>
<context>
    <name>RigPage</name>
    <message>
        <source>Pairing photographs</source>
        <translation>正在配对照片</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>正在打开 {0}</translation>
    </message>
    <message>
        <source>&amp;Folders…</source>
        <translation>文件夹(&amp;F)…</translation>
    </message>
    <message>
        <source>O&amp;pen rig…</source>
        <translation>打开相机组(&amp;P)…</translation>
    </message>
    <message>
        <source>&amp;Calibrate rig</source>
        <translation>标定相机组(&amp;C)</translation>
    </message>
    <message>
        <source>&amp;Stop</source>
        <translation>停止(&amp;S)</translation>
    </message>
    <message>
        <source>C&amp;lose</source>
        <translation>关闭(&amp;L)</translation>
    </message>
    <message>
        <source>Set-&amp;up</source>
        <translation>设置(&amp;U)</translation>
    </message>
    <message>
        <source>What is stated of boards and photographs, to change it</source>
        <translation>查看并修改标定板和照片的设置</translation>
    </message>
    <message>
        <source>E&amp;xport</source>
        <translation>导出(&amp;X)</translation>
    </message>
    <message>
        <source>Rig, with everything (JSON)…</source>
        <translation>相机组，全部内容 (JSON)…</translation>
    </message>
    <message>
        <source>Photographs</source>
        <translation>照片</translation>
    </message>
    <message>
        <source>Rectified</source>
        <translation>已校正</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>三维</translation>
    </message>
    <message>
        <source>Several cameras</source>
        <translation>多台相机</translation>
    </message>
    <message>
        <source>Cameras that stand fast to each other and photograph one board together: choose the folder that holds a folder for each camera (or all photographs, named as left01 and right01), or drop the folders here, or a video of each camera.</source>
        <translation>相对固定并同时拍摄同一标定板的多台相机：选择包含每台相机一个文件夹的文件夹（或所有照片，命名如 left01 和 right01），或将这些文件夹拖放到此处，或每台相机的一段视频。</translation>
    </message>
    <message>
        <source>No photographs yet.</source>
        <translation>还没有照片。</translation>
    </message>
    <message>
        <source>Calibrate the rig first.</source>
        <translation>请先标定相机组。</translation>
    </message>
    <message>
        <source>No two cameras have a photograph of one instant.</source>
        <translation>没有两台相机有同一时刻的照片。</translation>
    </message>
    <message>
        <source>{0} and {1} have no photographs of this instant together.</source>
        <translation>{0} 和 {1} 没有此时刻的共同照片。</translation>
    </message>
    <message>
        <source>Searching</source>
        <translation>正在搜索</translation>
    </message>
    <message>
        <source>Calibrating {0}</source>
        <translation>正在标定 {0}</translation>
    </message>
    <message>
        <source>Lengths hold {0}.</source>
        <translation>长度成立 {0}。</translation>
    </message>
    <message>
        <source>Folder with a folder for each camera, or the photographs of all</source>
        <translation>含每台相机文件夹或全部照片的文件夹</translation>
    </message>
    <message>
        <source>Open rig</source>
        <translation>打开相机组</translation>
    </message>
    <message>
        <source>Rigs (*.json)</source>
        <translation>相机组 (*.json)</translation>
    </message>
    <message>
        <source>Save rig</source>
        <translation>保存相机组</translation>
    </message>
    <message>
        <source>Wrote {0}.</source>
        <translation>已写入 {0}。</translation>
    </message>
</context>
<context>
    <name>RoiBar</name>
    <message>
        <source>&amp;Accept</source>
        <translation>接受(&amp;A)</translation>
    </message>
    <message>
        <source>Lea&amp;ve</source>
        <translation>离开(&amp;V)</translation>
    </message>
    <message>
        <source>rows of inner corners</source>
        <translation>内角点行数</translation>
    </message>
    <message>
        <source>columns of inner corners</source>
        <translation>内角点列数</translation>
    </message>
    <message>
        <source>As counted between the clicks, with those clicked. State it if the count is wrong.</source>
        <translation>按点击之间计数，含点击的角点。数目不对时请指定。</translation>
    </message>
    <message>
        <source>Keep these corners and go on (Enter)</source>
        <translation>保留这些角点并继续 (Enter)</translation>
    </message>
    <message>
        <source>Leave the image as it was (Esc)</source>
        <translation>图像保持原样 (Esc)</translation>
    </message>
</context>
<context>
    <name>Saver</name>
    <message>
        <source>The program&apos;s own folder cannot be used: recent projects and work that is not saved are kept in {0}, until the computer is started anew. Check HOME.</source>
        <translation>程序自己的文件夹无法使用：最近的项目和未保存的工作存放在 {0}，直到计算机重启。请检查 HOME。</translation>
    </message>
    <message>
        <source>Opening {0}</source>
        <translation>正在打开 {0}</translation>
    </message>
    <message>
        <source>{0} is open in another window, too ({1}). What is saved there is not seen here; before it is replaced you are asked.</source>
        <translation>{0} 也在另一个窗口中打开 ({1})。那里保存的内容此处看不到；替换之前会询问。</translation>
    </message>
    <message>
        <source>Recovering {0}</source>
        <translation>正在恢复 {0}</translation>
    </message>
    <message>
        <source>Untitled</source>
        <translation>未命名</translation>
    </message>
    <message>
        <source>Saving {0}</source>
        <translation>正在保存 {0}</translation>
    </message>
</context>
<context>
    <name>Scatters</name>
    <message>
        <source>real</source>
        <translation>真实</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>合成</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>参考 px</translation>
    </message>
</context>
<context>
    <name>SensorFigure</name>
    <message>
        <source>How far off the camera puts a distant point in the image (one standard deviation), as the verdict has it: beside the camera that mends the findings, if there are any.
The colours: where the calibration&apos;s own uncertainty is small (dark) and large.</source>
        <translation>相机把远处的点在图像中放偏了多少（一个标准差），按结论：有问题时相对于修正后的相机。
颜色：标定自身的不确定度小（深色）和大的地方。</translation>
    </message>
    <message>
        <source>Error of a pixel</source>
        <translation>像素误差</translation>
    </message>
    <message>
        <source>Now: {0}</source>
        <translation>现在：{0}</translation>
    </message>
    <message>
        <source>{0} px</source>
        <translation>{0} px</translation>
    </message>
    <message>
        <source>centre</source>
        <translation>中心</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>边缘</translation>
    </message>
    <message>
        <source>worst pixel</source>
        <translation>最差像素</translation>
    </message>
</context>
<context>
    <name>Sentences</name>
    <message>
        <source>The photographs show nothing wrong.</source>
        <translation>照片没有显示任何问题。</translation>
    </message>
    <message>
        <source>The views do not determine the camera.</source>
        <translation>视图不能确定相机。</translation>
    </message>
    <message>
        <source>The calibration is not finished.</source>
        <translation>标定没有完成。</translation>
    </message>
    <message>
        <source>One view cannot be checked.</source>
        <translation>只有一个视图无法检查。</translation>
    </message>
    <message>
        <source>{0} views are too few.</source>
        <translation>{0} 个视图太少。</translation>
    </message>
    <message>
        <source>{0} views are too few: take {1} or more, tilted in all directions.</source>
        <translation>{0} 个视图太少：请拍 {1} 个或更多，向各方向倾斜。</translation>
    </message>
    <message>
        <source>The camera is not known well enough: add photographs.</source>
        <translation>相机的标定还不够准确：请添加照片。</translation>
    </message>
    <message>
        <source>Nothing needs to be done: the camera is known to {0} px.</source>
        <translation>无需处理：相机的误差为 {0} px。</translation>
    </message>
    <message>
        <source>The camera is known to {0} px.</source>
        <translation>相机的误差为 {0} px。</translation>
    </message>
    <message>
        <source>The photographs show nothing wrong, but the camera is known to {0} px only: add photographs.</source>
        <translation>照片没有问题，但相机的误差仍有 {0} px：请添加照片。</translation>
    </message>
    <message>
        <source>Nothing is wrong where corners were seen: the camera is known to {0} px.</source>
        <translation>在拍到角点的地方没有问题：相机的误差为 {0} px。</translation>
    </message>
    <message>
        <source>Beyond them it is known to {0} px: hold the board closer to the image&apos;s edges.</source>
        <translation>在其之外误差为 {0} px：请将标定板靠近图像边缘。</translation>
    </message>
    <message>
        <source>Beyond them it is not known: hold the board closer to the image&apos;s edges.</source>
        <translation>在其之外误差未知：请将标定板靠近图像边缘。</translation>
    </message>
    <message>
        <source>Add views with the board tilted by {0} to {1} degrees in different directions and all over the image; six good ones are enough.</source>
        <translation>添加标定板向不同方向倾斜 {0} 到 {1} 度且遍布图像的视图；六个好的就够。</translation>
    </message>
    <message>
        <source>The views are too few, or too much alike.</source>
        <translation>视图太少，或彼此太相似。</translation>
    </message>
    <message>
        <source>Your board is not printed true.</source>
        <translation>您的标定板印刷不准确。</translation>
    </message>
    <message>
        <source>Your board is not flat.</source>
        <translation>您的标定板不平。</translation>
    </message>
    <message>
        <source>Your board is not flat, or not printed true.</source>
        <translation>您的标定板不平，或印刷不准确。</translation>
    </message>
    <message>
        <source>Your board is not flat ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>您的标定板不平 ({0} mm)：已估计其形状；误差减小到 1/{1}。</translation>
    </message>
    <message>
        <source>Your board is not printed true ({0} mm): its shape was estimated; errors {1} times smaller.</source>
        <translation>您的标定板印刷不准确 ({0} mm)：已估计其形状；误差减小到 1/{1}。</translation>
    </message>
    <message>
        <source>The lens model {0} does not follow this lens.</source>
        <translation>镜头模型 {0} 不适合这个镜头。</translation>
    </message>
    <message>
        <source>{0} does not belong to the others.</source>
        <translation>{0} 与其他照片不符。</translation>
    </message>
    <message>
        <source>{0} do not belong to the others.</source>
        <translation>{0} 与其他照片不符。</translation>
    </message>
    <message>
        <source>{0} is blurred, which does no harm here.</source>
        <translation>{0} 模糊，但在此无碍。</translation>
    </message>
    <message>
        <source>{0} are blurred, which does no harm here.</source>
        <translation>{0} 模糊，但在此无碍。</translation>
    </message>
    <message>
        <source>The images were scaled, by the camera or a program.</source>
        <translation>图像被相机或程序缩放过。</translation>
    </message>
    <message>
        <source>One view does not determine a camera, which leaves {0} unknown.</source>
        <translation>一张照片不足以确定相机：{0} 未知。</translation>
    </message>
    <message>
        <source>The focal length differs between the views.</source>
        <translation>各视图的焦距不同。</translation>
    </message>
    <message>
        <source>Switch autofocus and stabilisation off, and do not touch zoom and focus.</source>
        <translation>请关闭自动对焦和防抖，不要动变焦和对焦。</translation>
    </message>
    <message>
        <source>Some views show the corners less well than the others.</source>
        <translation>一些视图中的角点不如其他视图清楚。</translation>
    </message>
    <message>
        <source>Tool ± {0} mm, ± {1} degrees (k = 2); robot {2} %, camera {3} %, from {4} poses</source>
        <translation>工具 ± {0} mm,± {1} 度(k = 2);机器人 {2} %,相机 {3} %,来自 {4} 个位姿</translation>
    </message>
    <message>
        <source>The robot&apos;s poses are {0}.</source>
        <translation>机器人的位姿为:{0}。</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in degrees, {1}</source>
        <translation>{0} 的角 a、b、c(度),{1}</translation>
    </message>
    <message>
        <source>angles a, b, c of {0} in radians, {1}</source>
        <translation>{0} 的角 a、b、c(弧度),{1}</translation>
    </message>
    <message>
        <source>rotation vectors in degrees, {0}</source>
        <translation>旋转向量(度),{0}</translation>
    </message>
    <message>
        <source>rotation vectors in radians, {0}</source>
        <translation>旋转向量(弧度),{0}</translation>
    </message>
    <message>
        <source>quaternions {0}</source>
        <translation>四元数 {0}</translation>
    </message>
    <message>
        <source>x, y, z, w, {0}</source>
        <translation>x、y、z、w,{0}</translation>
    </message>
    <message>
        <source>w, x, y, z, {0}</source>
        <translation>w、x、y、z,{0}</translation>
    </message>
    <message>
        <source>matrices row by row, {0}</source>
        <translation>按行排列的矩阵,{0}</translation>
    </message>
    <message>
        <source>matrices column by column, {0}</source>
        <translation>按列排列的矩阵,{0}</translation>
    </message>
    <message>
        <source>rotations transposed, {0}</source>
        <translation>旋转已转置,{0}</translation>
    </message>
    <message>
        <source>millimetres, {0}</source>
        <translation>毫米,{0}</translation>
    </message>
    <message>
        <source>metres, {0}</source>
        <translation>米,{0}</translation>
    </message>
    <message>
        <source>base from hand</source>
        <translation>手到基座</translation>
    </message>
    <message>
        <source>hand from base</source>
        <translation>基座到手</translation>
    </message>
    <message>
        <source>camera in the hand</source>
        <translation>相机在手上</translation>
    </message>
    <message>
        <source>camera beside the robot</source>
        <translation>相机在机器人旁</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm.</source>
        <translation>如此读取时,标定板散布为 {0} mm。</translation>
    </message>
    <message>
        <source>Read so, the board scatters by {0} mm, and by {1} mm in any other way.</source>
        <translation>如此读取时,标定板散布为 {0} mm,其他任何读法为 {1} mm。</translation>
    </message>
    <message>
        <source>A pose of the robot is off by {0} mm along each axis and by {1} degrees about each, one standard deviation.</source>
        <translation>机器人位姿沿各轴偏差 {0} mm,绕各轴偏差 {1} 度(一个标准差)。</translation>
    </message>
    <message>
        <source>The corners are off by {0} px.</source>
        <translation>角点偏差 {0} px。</translation>
    </message>
    <message>
        <source>The poses fit as well as {0}.</source>
        <translation>这些位姿同样符合:{0}。</translation>
    </message>
    <message>
        <source>Turn the hand about more axes, or state where the camera is (above).</source>
        <translation>请让手绕更多轴转动,或在上方指明相机位置。</translation>
    </message>
    <message>
        <source>Correct the file.</source>
        <translation>请改正文件。</translation>
    </message>
    <message>
        <source>{0} have the same pose of the robot: if it moved between them, the file is wrong.</source>
        <translation>{0} 的机器人位姿相同:若其间机器人移动过,则文件有误。</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the hand.</source>
        <translation>未定:相机可能绕手的 {0} 转动。</translation>
    </message>
    <message>
        <source>Open: the camera may be turned about {0} of the base.</source>
        <translation>未定:相机可能绕基座的 {0} 转动。</translation>
    </message>
    <message>
        <source>any axis</source>
        <translation>任意轴</translation>
    </message>
    <message>
        <source>Turn the hand about another axis as well, or move it without turning.</source>
        <translation>请让手也绕另一轴转动,或只平移不转动。</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the hand.</source>
        <translation>未定:相机可能沿手的 {0} 平移。</translation>
    </message>
    <message>
        <source>Open: the camera may be shifted along {0} of the base.</source>
        <translation>未定:相机可能沿基座的 {0} 平移。</translation>
    </message>
    <message>
        <source>All else is determined, and no ± counts this.</source>
        <translation>其余均已确定,但任何 ± 都未计入此项。</translation>
    </message>
    <message>
        <source>Turn the hand about {0}, or measure it.</source>
        <translation>请让手绕{0}转动,或直接测量。</translation>
    </message>
    <message>
        <source>a second axis</source>
        <translation>第二个轴</translation>
    </message>
    <message>
        <source>two axes</source>
        <translation>两个轴</translation>
    </message>
    <message>
        <source>other axes</source>
        <translation>其他轴</translation>
    </message>
    <message>
        <source>The robot&apos;s pose does not fit in {0}: another moment, or a mistake in the file.</source>
        <translation>{0} 中机器人位姿不符:时刻不同,或文件有误。</translation>
    </message>
    <message>
        <source>Left out: {0}</source>
        <translation>已排除:{0}</translation>
    </message>
    <message>
        <source>No ± counts the camera&apos;s errors: its file does not state them.</source>
        <translation>任何 ± 都未计入相机误差:其文件未给出。</translation>
    </message>
    <message>
        <source>The robot&apos;s poses do not fit the photographs, however they are read: at best the board scatters by {0} mm in the robot&apos;s frame.</source>
        <translation>无论如何读取,机器人位姿都与照片不符:标定板在机器人坐标系中至少散布 {0} mm。</translation>
    </message>
    <message>
        <source>Check that they are the poses of these photographs in this order, and that board and camera stayed fixed, one to the hand and the other to the base.</source>
        <translation>请检查这些位姿是否按此顺序属于这些照片,且标定板与相机是否分别固定在手上和基座上。</translation>
    </message>
    <message>
        <source>By the robot&apos;s motions the board&apos;s squares are {0} times as long as stated.</source>
        <translation>根据机器人的运动,标定板方格为所述长度的 {0} 倍。</translation>
    </message>
    <message>
        <source>State the side of a square as it was printed.</source>
        <translation>请给出实际打印的方格边长。</translation>
    </message>
    <message>
        <source>There are {0} different poses of the robot with a board; hand and eye need at least {1}.</source>
        <translation>有标定板的不同机器人位姿为 {0} 个;手眼标定至少需要 {1} 个。</translation>
    </message>
    <message>
        <source>Photograph the board from ten poses or more, turned about two axes at least.</source>
        <translation>请从至少十个位姿拍摄标定板,并至少绕两个轴转动。</translation>
    </message>
    <message>
        <source>{0} has {1} poses, and there are {2} photographs.</source>
        <translation>{0} 有 {1} 个位姿,而照片有 {2} 张。</translation>
    </message>
    <message>
        <source>Give a pose for each photograph, in the order of their names, or name the photographs in the first column.</source>
        <translation>请按名称顺序为每张照片给出一个位姿,或在第一列写明照片名称。</translation>
    </message>
    <message>
        <source>{0} names none of the photographs.</source>
        <translation>{0} 未提及任何照片。</translation>
    </message>
    <message>
        <source>Name them as they are called, as {0}.</source>
        <translation>请使用照片的实际名称,例如 {0}。</translation>
    </message>
    <message>
        <source>{0} holds no poses.</source>
        <translation>{0} 不含位姿。</translation>
    </message>
    <message>
        <source>{0} is {1} ms {2} than {3}.</source>
        <translation>{0} 比 {3} {2} {1} ms。</translation>
    </message>
    <message>
        <source>later</source>
        <translation>晚</translation>
    </message>
    <message>
        <source>earlier</source>
        <translation>早</translation>
    </message>
    <message>
        <source>Photographs of {0} cameras: {1}.</source>
        <translation>{0} 台相机的照片:{1}。</translation>
    </message>
    <message>
        <source>Paired by their {0}: {1} of several cameras, the first {2}.</source>
        <translation>按{0}配对:多台相机的{1},第一个为 {2}。</translation>
    </message>
    <message>
        <source>before the place {0}</source>
        <translation>(位于位置之前){0}</translation>
    </message>
    <message>
        <source>The order is shifted: each pose stands {0}, and was used for the photograph that it fits.</source>
        <translation>顺序有偏移:每个位姿{0},已用于与之相符的照片。</translation>
    </message>
    <message>
        <source>one line early</source>
        <translation>早了一行</translation>
    </message>
    <message>
        <source>one line late</source>
        <translation>晚了一行</translation>
    </message>
    <message>
        <source>Leave it out {0}.</source>
        <translation>请在{0}将其排除。</translation>
    </message>
    <message>
        <source>below</source>
        <translation>下方</translation>
    </message>
    <message>
        <source>names</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>numbers</source>
        <translation>编号</translation>
    </message>
    <message>
        <source>times, which are at most {0} ms apart</source>
        <translation>时间(相差至多 {0} ms)</translation>
    </message>
    <message>
        <source>1 instant</source>
        <translation>1 个时刻</translation>
    </message>
    <message>
        <source>{0} instants</source>
        <translation>{0} 个时刻</translation>
    </message>
    <message>
        <source>Without a partner: {0}.</source>
        <translation>无配对:{0}。</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px.</source>
        <translation>{0} 台相机,{1}:联合残差 {2} px,各自单独 {3} px。</translation>
    </message>
    <message>
        <source>{0} cameras at {1}: together they leave {2} px, each alone {3} px, {4} times less.</source>
        <translation>{0} 台相机,{1}:联合残差 {2} px,各自单独 {3} px,小 {4} 倍。</translation>
    </message>
    <message>
        <source>They agree.</source>
        <translation>它们一致。</translation>
    </message>
    <message>
        <source>The instants disagree.</source>
        <translation>各时刻不一致。</translation>
    </message>
    <message>
        <source>Single instants have {0} mm from where most have it beside {1}; the corners&apos; noise explains {2} mm.</source>
        <translation>单个时刻将 {0} mm 偏离多数时刻相对 {1} 的位置;角点噪声可解释 {2} mm。</translation>
    </message>
    <message>
        <source>Photographs of one instant were not taken at quite the same moment, or the board bends in the hand.</source>
        <translation>同一时刻的照片并非完全同时拍摄,或标定板在手中弯曲。</translation>
    </message>
    <message>
        <source>Each ± counts it: put the board down for each picture, or trigger the cameras together.</source>
        <translation>每个 ± 均已计入:请每次拍摄时放稳标定板,或同步触发相机。</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} earlier: nothing above holds.</source>
        <translation>{0} 的照片属于 {1} 早 {2} 的照片:以上结果均无效。</translation>
    </message>
    <message>
        <source>The photographs of {0} belong to those of {1} of {2} later: nothing above holds.</source>
        <translation>{0} 的照片属于 {1} 晚 {2} 的照片:以上结果均无效。</translation>
    </message>
    <message>
        <source>Pair them so.</source>
        <translation>请如此配对。</translation>
    </message>
    <message>
        <source>Exchanged with those of {0}: {1}.</source>
        <translation>与 {0} 的照片互换:{1}。</translation>
    </message>
    <message>
        <source>They are left out; give them back their names.</source>
        <translation>它们已被排除;请恢复其名称。</translation>
    </message>
    <message>
        <source>The squares were counted {0} times as long as in the others in {1}, and the photographs of {2} beside them.</source>
        <translation>在 {1} 及与之对应的 {2} 照片中,方格被当作其余照片的 {0} 倍长。</translation>
    </message>
    <message>
        <source>They are left out: is that another board, or another --square?</source>
        <translation>它们已被排除:是另一块板,还是方格边长不同?</translation>
    </message>
    <message>
        <source>{0} stands {1} mm otherwise beside {2} from {3} on.</source>
        <translation>自 {3} 起,{0} 相对 {2} 偏移 {1} mm。</translation>
    </message>
    <message>
        <source>Calibrate the photographs before and after it by themselves.</source>
        <translation>请将其前后的照片分别标定。</translation>
    </message>
    <message>
        <source>The boards stand {0} mm otherwise to each other from {1} on.</source>
        <translation>自 {1} 起,各标定板之间相对偏移 {0} mm。</translation>
    </message>
    <message>
        <source>Fasten them, or calibrate the photographs before and after it by themselves.</source>
        <translation>请将其固定,或将其前后的照片分别标定。</translation>
    </message>
    <message>
        <source>The focal length of {0} is {1} times as long from {2} on: it was refocused or zoomed.</source>
        <translation>自 {2} 起,{0} 的焦距变为 {1} 倍:曾重新对焦或变焦。</translation>
    </message>
    <message>
        <source>Left out, as the board is elsewhere than in the other cameras&apos; photographs of the instant: {0}.</source>
        <translation>已排除,因为标定板位置与其他相机同一时刻的照片不符:{0}。</translation>
    </message>
    <message>
        <source>Were they taken at another instant?</source>
        <translation>它们是否在另一时刻拍摄?</translation>
    </message>
    <message>
        <source>Those that agree least with the other cameras: {0}.</source>
        <translation>与其他相机最不一致的:{0}。</translation>
    </message>
    <message>
        <source>Counted from another end of the board, and turned back: {0}.</source>
        <translation>从标定板另一端计数,已转正:{0}。</translation>
    </message>
    <message>
        <source>Where {0} stands beside {1} is open: no two cameras saw them at one instant.</source>
        <translation>{0} 相对 {1} 的位置未定:没有两台相机在同一时刻看到它们。</translation>
    </message>
    <message>
        <source>Nothing else depends on it.</source>
        <translation>其他结果不受影响。</translation>
    </message>
    <message>
        <source>{0} deviates from its drawing by {1} mm rms, at most {2} mm.</source>
        <translation>{0} 与图纸偏差 {1} mm(RMS),最大 {2} mm。</translation>
    </message>
    <message>
        <source>board {0}</source>
        <translation>标定板 {0}</translation>
    </message>
    <message>
        <source>Board {0}</source>
        <translation>标定板 {0}</translation>
    </message>
    <message>
        <source>The board</source>
        <translation>标定板</translation>
    </message>
    <message>
        <source>The board moved while the cameras&apos; clocks did not agree: with one offset in time for each camera they leave {0} px.</source>
        <translation>相机时钟不一致时标定板在移动:若每台相机有一个时间偏移,残差为 {0} px。</translation>
    </message>
    <message>
        <source>--offsets estimates these.</source>
        <translation>可在设置中估计该偏移。</translation>
    </message>
    <message>
        <source>The kind or the size of {0} is not stated.</source>
        <translation>未给出 {0} 的类型或尺寸。</translation>
    </message>
    <message>
        <source>State both of each board (--target and --board on the command line).</source>
        <translation>请给出每块板的类型和尺寸。</translation>
    </message>
    <message>
        <source>Nothing is stated of {0} that tells it from the other boards.</source>
        <translation>未给出能将 {0} 与其他板区分的信息。</translation>
    </message>
    <message>
        <source>Several boards have markers or tags: state --target and --board of each, and the --dictionary of a ChArUco board, the --family of one with AprilTags.</source>
        <translation>多块板须带标记或标签:请给出每块的类型和尺寸,以及 ChArUco 板的字典或 AprilTag 板的家族。</translation>
    </message>
    <message>
        <source>The markers {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>{2} 的标记 {0} 至 {1} 同时出现在 {3} 和 {4} 上:照片无法区分这些板。</translation>
    </message>
    <message>
        <source>The tags {0} to {1} of {2} are on {3} and on {4}: photographs do not tell the boards apart.</source>
        <translation>{2} 的标签 {0} 至 {1} 同时出现在 {3} 和 {4} 上:照片无法区分这些板。</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that never see the board together: {1}.</source>
        <translation>相机分成 {0} 组,从未共同看到标定板:{1}。</translation>
    </message>
    <message>
        <source>The cameras fall apart into {0} groups that nothing joins: {1}.</source>
        <translation>相机分成 {0} 组,彼此没有联系:{1}。</translation>
    </message>
    <message>
        <source>{0} shows no board of {1} in any photograph, and {2} does.</source>
        <translation>{0} 的照片中没有 {1} 的板,而 {2} 有。</translation>
    </message>
    <message>
        <source>A rig takes one board before all cameras: photograph the same one, or leave out the camera that saw another.</source>
        <translation>所有相机须拍摄同一块板:请拍摄同一块,或排除看到另一块板的相机。</translation>
    </message>
</context>
<context>
    <name>SeriesDialog</name>
    <message>
        <source>Series of calibrations</source>
        <translation>标定系列</translation>
    </message>
    <message>
        <source>&amp;Add results…</source>
        <translation>添加结果(&amp;A)…</translation>
    </message>
    <message>
        <source>The quantity that varies</source>
        <translation>变化的量</translation>
    </message>
    <message>
        <source>zoom</source>
        <translation>变焦</translation>
    </message>
    <message>
        <source>focus</source>
        <translation>对焦</translation>
    </message>
    <message>
        <source>temperature</source>
        <translation>温度</translation>
    </message>
    <message>
        <source>date</source>
        <translation>日期</translation>
    </message>
    <message>
        <source>&amp;Table of values…</source>
        <translation>数值表(&amp;T)…</translation>
    </message>
    <message>
        <source>A CSV file with the columns file,value; temperatures in °C. Without one focal lengths and dates are read from the photographs.</source>
        <translation>含 file,value 两列的 CSV 文件；温度单位 °C。没有它时从照片读取焦距和日期。</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Value at which the camera is shown</source>
        <translation>显示相机所取的值</translation>
    </message>
    <message>
        <source>Format</source>
        <translation>格式</translation>
    </message>
    <message>
        <source>&amp;Export…</source>
        <translation>导出(&amp;E)…</translation>
    </message>
    <message>
        <source>Add the result.json of each setting of one camera: three or more.</source>
        <translation>添加同一相机各设置的 result.json：三个或更多。</translation>
    </message>
    <message>
        <source>by</source>
        <translation>按</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>结果</translation>
    </message>
    <message>
        <source>Camera at a value</source>
        <translation>某值处的相机</translation>
    </message>
    <message>
        <source>Camera at</source>
        <translation>相机在</translation>
    </message>
    <message>
        <source>as</source>
        <translation>为</translation>
    </message>
    <message>
        <source>Results (*.json)</source>
        <translation>结果 (*.json)</translation>
    </message>
    <message>
        <source>Table of values</source>
        <translation>数值表</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>表格 (*.csv)</translation>
    </message>
    <message>
        <source>working…</source>
        <translation>正在计算…</translation>
    </message>
    <message>
        <source>Fitting the series</source>
        <translation>正在拟合系列</translation>
    </message>
    <message>
        <source>From {0} to {1}; empty to write a profile of all focal lengths</source>
        <translation>从 {0} 到 {1}；留空则写出所有焦距的配置</translation>
    </message>
    <message>
        <source>File</source>
        <translation>文件</translation>
    </message>
    <message>
        <source>px</source>
        <translation>px</translation>
    </message>
    <message>
        <source>From the first</source>
        <translation>与首个</translation>
    </message>
    <message>
        <source>Difference from the first camera after a rotation, rms</source>
        <translation>与首个相机的差异，去除旋转，均方根</translation>
    </message>
    <message>
        <source>Explained</source>
        <translation>可解释</translation>
    </message>
    <message>
        <source>Difference that the calibrations&apos; uncertainties explain</source>
        <translation>标定的不确定度可解释的差异</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>概率</translation>
    </message>
    <message>
        <source>Of a difference as large as this one if the camera has not changed</source>
        <translation>相机未改变时出现这么大差异的概率</translation>
    </message>
    <message>
        <source>Changed</source>
        <translation>已变</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>已用</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>已排除</translation>
    </message>
    <message>
        <source>Reason</source>
        <translation>原因</translation>
    </message>
    <message>
        <source>no</source>
        <translation>否</translation>
    </message>
    <message>
        <source>{0} is no value of {1}.</source>
        <translation>{0} 不是{1}的值。</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>值</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>导出</translation>
    </message>
    <message>
        <source>Saved as {0}. {1}</source>
        <translation>已保存为 {0}。{1}</translation>
    </message>
    <message>
        <source>Writing {0}</source>
        <translation>正在写入 {0}</translation>
    </message>
</context>
<context>
    <name>Session</name>
    <message>
        <source>Out of date, as images or board have changed: calibrate again.</source>
        <translation>已过时，图像或标定板已改变：请重新标定。</translation>
    </message>
    <message>
        <source>Out of date, as settings have changed: calibrate again.</source>
        <translation>已过时，设置已改变：请重新标定。</translation>
    </message>
</context>
<context>
    <name>SettingsPanel</name>
    <message>
        <source>&amp;Leave outliers out</source>
        <translation>排除离群值(&amp;L)</translation>
    </message>
    <message>
        <source>Remove corners and views that do not fit from the images, as by hand: undo brings them back. The result names them.</source>
        <translation>像手动一样从图像中去掉不符合的角点和视图：撤销可恢复。结果会列出它们。</translation>
    </message>
    <message>
        <source>&amp;Weigh views by their noise</source>
        <translation>按噪声给视图加权(&amp;W)</translation>
    </message>
    <message>
        <source>Make the camera bette&amp;r</source>
        <translation>改进相机(&amp;R)</translation>
    </message>
    <message>
        <source>Carry out what needs no new photograph and makes errors smaller by a fifth or more: another lens model or board shape where these are automatic, and leaving out corners and views that do not fit. Undo goes back through it.</source>
        <translation>执行不需要新照片且使误差减小五分之一以上的操作：在自动时换用其他镜头模型或板形，并排除不符合的角点和视图。撤销可逐步返回。</translation>
    </message>
    <message>
        <source>Search a&amp;gain with the camera</source>
        <translation>用相机再次搜索(&amp;G)</translation>
    </message>
    <message>
        <source>Once the camera is known, search the images without a board and the boards found in part again, and calibrate from what that gains.</source>
        <translation>相机已知后，再次搜索没有标定板和只找到一部分的图像，并用所得重新标定。</translation>
    </message>
    <message>
        <source>Calibrate again</source>
        <translation>重新标定</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation>自动</translation>
    </message>
    <message>
        <source>The paper&apos;s model, unless views that the models have not seen demand another. The result says why. Slower.</source>
        <translation>论文的模型，除非模型未见过的视图要求另一种。结果会说明原因。较慢。</translation>
    </message>
    <message>
        <source>Lens model</source>
        <translation>镜头模型</translation>
    </message>
    <message>
        <source>Values of held parameters</source>
        <translation>固定参数的值</translation>
    </message>
    <message>
        <source>Parameters that are held at values of their own, as fx=650, p1=0. Of the others that are held coefficients are 0, the centre is the image&apos;s and focal lengths are those of the closed form.</source>
        <translation>固定在自身数值的参数，如 fx=650, p1=0。其他固定的系数为 0，中心为图像中心，焦距取闭式解。</translation>
    </message>
    <message>
        <source>&amp;Minimise</source>
        <translation>最小化(&amp;M)</translation>
    </message>
    <message>
        <source>Held at</source>
        <translation>固定在</translation>
    </message>
    <message>
        <source>Camera</source>
        <translation>相机</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>方法</translation>
    </message>
    <message>
        <source>Estimate</source>
        <translation>估计</translation>
    </message>
    <message>
        <source>The chosen method has nothing else to minimise.</source>
        <translation>所选方法没有其他可最小化的量。</translation>
    </message>
    <message>
        <source>The error in the image takes any board.</source>
        <translation>图像误差适用于任何标定板。</translation>
    </message>
    <message>
        <source>The chosen method takes every board as it is drawn.</source>
        <translation>所选方法把标定板按图纸处理。</translation>
    </message>
    <message>
        <source>Only the error in the image takes weights.</source>
        <translation>只有图像误差可加权。</translation>
    </message>
    <message>
        <source>Poor views then spoil less. Best with an estimated shape of the board, which would else pass for noise.</source>
        <translation>差的视图影响较小。最好同时估计板形，否则它会被当作噪声。</translation>
    </message>
    <message>
        <source>The chosen method takes all corners as equally good.</source>
        <translation>所选方法认为所有角点同样好。</translation>
    </message>
    <message>
        <source>The chosen method has its own lens model: what its authors corrected.</source>
        <translation>所选方法有自己的镜头模型：其作者所校正的。</translation>
    </message>
    <message>
        <source>The formulation of the paper has its own lens model, with a radius in pixels.</source>
        <translation>论文的公式有自己的镜头模型，半径以像素计。</translation>
    </message>
    <message>
        <source>How the lens bends what a pinhole would image; the result is of it.</source>
        <translation>镜头如何弯曲针孔所成的像；结果即为此模型。</translation>
    </message>
    <message>
        <source>Estimate {0}; otherwise it is held, coefficients at 0.</source>
        <translation>估计 {0}；否则固定，系数为 0。</translation>
    </message>
    <message>
        <source>The chosen method cannot estimate {0}.</source>
        <translation>所选方法不能估计 {0}。</translation>
    </message>
    <message>
        <source>Calibration settings</source>
        <translation>标定设置</translation>
    </message>
</context>
<context>
    <name>SetupSheet</name>
    <message>
        <source>Board</source>
        <translation>标定板</translation>
    </message>
    <message>
        <source>What is photographed</source>
        <translation>拍摄的对象</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>镜头</translation>
    </message>
    <message>
        <source>Which model describes the lens</source>
        <translation>用哪个模型描述镜头</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>限值</translation>
    </message>
    <message>
        <source>What is demanded of the camera</source>
        <translation>对相机的要求</translation>
    </message>
    <message>
        <source>For experts</source>
        <translation>专家设置</translation>
    </message>
    <message>
        <source>How to calibrate</source>
        <translation>如何标定</translation>
    </message>
</context>
<context>
    <name>SourceList</name>
    <message>
        <source>&amp;Another camera</source>
        <translation>再加一台相机(&amp;A)</translation>
    </message>
    <message>
        <source>&amp;Remove</source>
        <translation>移除(&amp;R)</translation>
    </message>
    <message>
        <source>Several cameras that stand fast to each other take each picture together</source>
        <translation>相互固定的多台相机同时拍摄每一张照片</translation>
    </message>
    <message>
        <source>Camera {0}</source>
        <translation>相机 {0}</translation>
    </message>
    <message>
        <source>A camera at this computer, or the address of one in the network (rtsp://…, http://…), or the folder that a camera&apos;s program fills</source>
        <translation type="unfinished">本机的相机，网络相机的地址 (rtsp://…, http://…)，或相机程序写入的文件夹</translation>
    </message>
    <message>
        <source>camera {0}</source>
        <translation type="unfinished">相机 {0}</translation>
    </message>
</context>
<context>
    <name>SquareRow</name>
    <message>
        <source>Only lengths depend on it, no pixel does. Until it is confirmed, every length holds on this condition.</source>
        <translation>只有长度取决于它，像素不取决于它。确认之前，每个长度都以此为条件。</translation>
    </message>
    <message>
        <source>Confirm</source>
        <translation>确认</translation>
    </message>
    <message>
        <source>Size of squares</source>
        <translation>方格大小</translation>
    </message>
    <message>
        <source>Confirm the size of squares</source>
        <translation>确认方格大小</translation>
    </message>
    <message>
        <source>Lengths hold: you have confirmed {0:g} {1}.</source>
        <translation>长度有效：您已确认 {0:g} {1}。</translation>
    </message>
    <message>
        <source>How far apart are the circles? {2}, {0} × {1}.</source>
        <translation>圆的间距是多少？{2}，{0} × {1}。</translation>
    </message>
    <message>
        <source>How far apart are the circles? The board is being counted.</source>
        <translation>圆的间距是多少？正在计数。</translation>
    </message>
    <message>
        <source>How far apart are the circles? Their number is not known: state it in the Set-up.</source>
        <translation>圆的间距是多少？数目未知：请在设置中指定。</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? {2}, {0} × {1} corners.</source>
        <translation>标签边长是多少？{2}，{0} × {1} 个角点。</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? The board is being counted.</source>
        <translation>标签边长是多少？正在计数。</translation>
    </message>
    <message>
        <source>How long are the tags&apos; sides? Their number is not known: state it in the Set-up.</source>
        <translation>标签边长是多少？数目未知：请在设置中指定。</translation>
    </message>
    <message>
        <source>How long are the squares? {2}, {0} × {1} inner corners.</source>
        <translation>方格边长是多少？{2}，{0} × {1} 个内角点。</translation>
    </message>
    <message>
        <source>How long are the squares? The board is being counted.</source>
        <translation>方格边长是多少？正在计数。</translation>
    </message>
    <message>
        <source>How long are the squares? Their number is not known: state it in the Set-up.</source>
        <translation>方格边长是多少？数目未知：请在设置中指定。</translation>
    </message>
    <message>
        <source>Distance of circles</source>
        <translation>圆的间距</translation>
    </message>
    <message>
        <source>Side of a tag</source>
        <translation>标签边长</translation>
    </message>
    <message>
        <source>Side of a square</source>
        <translation>方格边长</translation>
    </message>
    <message>
        <source>Confirm {0:g} {1}</source>
        <translation>确认 {0:g} {1}</translation>
    </message>
    <message>
        <source>This length is confirmed already; state another one first.</source>
        <translation>此长度已确认；请先输入另一个。</translation>
    </message>
</context>
<context>
    <name>StageOnePanel</name>
    <message>
        <source>Stage I</source>
        <translation>第一阶段</translation>
    </message>
    <message>
        <source>What each view says of the camera by itself: the paper&apos;s first stage.</source>
        <translation>每个视图单独给出的相机：论文的第一阶段。</translation>
    </message>
    <message>
        <source>aspect ratio r</source>
        <translation>纵横比 r</translation>
    </message>
    <message>
        <source>g(r)</source>
        <translation>g(r)</translation>
    </message>
    <message>
        <source>The cosines&apos; equation of the selected view: where it is zero, r = fy / fx.
It has no value where the view&apos;s tilt does not determine it.</source>
        <translation>所选视图的余弦方程：为零处 r = fy / fx。
视图的倾斜不能确定它时没有值。</translation>
    </message>
    <message>
        <source>view</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>aspect ratio fy / fx</source>
        <translation>纵横比 fy / fx</translation>
    </message>
    <message>
        <source>The root of each view. Views near fronto-parallel, or tilted about one axis,
give none or a poor one: Stage II does not depend on them.</source>
        <translation>每个视图的根。接近正对或绕一轴倾斜的视图
没有根或根很差：第二阶段不依赖它们。</translation>
    </message>
    <message>
        <source>No view determines its aspect ratio.</source>
        <translation>没有视图能确定其纵横比。</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r = {1:.4f}</source>
        <translation>{0}&lt;br&gt;r = {1:.4f}</translation>
    </message>
    <message>
        <source>{0}&lt;br&gt;r is not determined</source>
        <translation>{0}&lt;br&gt;r 未确定</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>步数</translation>
    </message>
    <message>
        <source>Principal point right of the array&apos;s centre</source>
        <translation>主点在传感器中心右侧</translation>
    </message>
    <message>
        <source>Principal point above the centre</source>
        <translation>主点在中心上方</translation>
    </message>
    <message>
        <source>First radial coefficient</source>
        <translation>第一径向系数</translation>
    </message>
    <message>
        <source>Aspect ratio: root of the cosines&apos; equation</source>
        <translation>纵横比：余弦方程的根</translation>
    </message>
    <message>
        <source>Focal length</source>
        <translation>焦距</translation>
    </message>
    <message>
        <source>Iterations of Levenberg-Marquardt</source>
        <translation>Levenberg-Marquardt 迭代次数</translation>
    </message>
    <message>
        <source>px′</source>
        <translation>px′</translation>
    </message>
    <message>
        <source>Residual on the reference plane; px′ are its pixels, 30 to a square</source>
        <translation>参考平面上的残差；px′ 为其像素，每方格 30</translation>
    </message>
    <message>
        <source>View</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>σ</source>
        <translation>σ</translation>
    </message>
    <message>
        <source>Standard deviation of a coordinate, from RMS, corners and 11 unknowns</source>
        <translation>一个坐标的标准差，由 RMS、角点数和 11 个未知数得出</translation>
    </message>
    <message>
        <source>Corners</source>
        <translation type="unfinished">角点</translation>
    </message>
    <message>
        <source>Number of the view&apos;s corners</source>
        <translation>该视图的角点数</translation>
    </message>
    <message>
        <source>no convergence</source>
        <translation>未收敛</translation>
    </message>
    <message>
        <source>Far from the other views: {0}</source>
        <translation>与其他视图相差很大：{0}</translation>
    </message>
</context>
<context>
    <name>SyntheticPanel</name>
    <message>
        <source>Synthetic check</source>
        <translation>合成检查</translation>
    </message>
    <message>
        <source>Whether the method finds this camera again.</source>
        <translation>该方法能否重新找到这台相机。</translation>
    </message>
    <message>
        <source>&amp;Render and calibrate</source>
        <translation>渲染并标定(&amp;R)</translation>
    </message>
    <message>
        <source>Renders every view from the result, finds the corners again, adds the noise that
was found and calibrates: what must come back is known exactly.</source>
        <translation>由结果渲染视图，重新找到角点，加入测得的噪声
并标定：应得到什么是精确已知的。</translation>
    </message>
    <message>
        <source>Rendering the views and searching them…</source>
        <translation>正在渲染并搜索视图…</translation>
    </message>
    <message>
        <source>real</source>
        <translation>真实</translation>
    </message>
    <message>
        <source>synthetic</source>
        <translation>合成</translation>
    </message>
    <message>
        <source>Table</source>
        <translation>表格</translation>
    </message>
    <message>
        <source>Images</source>
        <translation>图像</translation>
    </message>
    <message>
        <source>Poses</source>
        <translation>位姿</translation>
    </message>
    <message>
        <source>Residuals</source>
        <translation>残差</translation>
    </message>
    <message>
        <source>Histograms</source>
        <translation>直方图</translation>
    </message>
    <message>
        <source>Table 3 of the paper</source>
        <translation>论文的表 3</translation>
    </message>
    <message>
        <source>The board&apos;s pattern is not known, so its views cannot be rendered.</source>
        <translation>标定板的图案未知，因此无法渲染其视图。</translation>
    </message>
    <message>
        <source>Would the method find this camera again, if it were just so?</source>
        <translation>如果相机恰好如此，方法能否重新找到它？</translation>
    </message>
    <message>
        <source>{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, real images {4:.3f} ± {5:.3f}.</source>
        <translation>{1} 个视图中重新找到 {0} 个。e′ = {2:.4f} ± {3:.4f} 参考 px，真实图像 {4:.3f} ± {5:.3f}。</translation>
    </message>
    <message>
        <source>Rendering {0}</source>
        <translation>正在渲染 {0}</translation>
    </message>
</context>
<context>
    <name>Table</name>
    <message>
        <source>Table</source>
        <translation>表格</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>复制</translation>
    </message>
    <message>
        <source>Save as CSV…</source>
        <translation>保存为 CSV…</translation>
    </message>
    <message>
        <source>Table of {0}</source>
        <translation>{0} 的表格</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>保存表格</translation>
    </message>
    <message>
        <source>Comma-separated values (*.csv)</source>
        <translation>逗号分隔值 (*.csv)</translation>
    </message>
</context>
<context>
    <name>TakenStrip</name>
    <message>
        <source>Pictures taken</source>
        <translation>已拍的照片</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>撤回(&amp;T)</translation>
    </message>
    <message>
        <source>{0} · put aside</source>
        <translation>{0} · 留出</translation>
    </message>
    <message>
        <source>{0}: a camera calibrated without it is checked with it as well</source>
        <translation>{0}：还用它检验一个未用它标定的相机</translation>
    </message>
    <message>
        <source>&amp;Take again</source>
        <translation>重新拍摄(&amp;T)</translation>
    </message>
</context>
<context>
    <name>Tour</name>
    <message>
        <source>Leave</source>
        <translation>离开</translation>
    </message>
    <message>
        <source>Your photographs</source>
        <translation>您的照片</translation>
    </message>
    <message>
        <source>The bar below each is how far its corners are from where the camera puts them. Drag the dashed line, and leave out what is above it.</source>
        <translation>每张下方的条表示角点与相机所算位置的距离。拖动虚线，排除高于它的照片。</translation>
    </message>
    <message>
        <source>One photograph</source>
        <translation>一张照片</translation>
    </message>
    <message>
        <source>The corners that were found. Where a board is missed, press Mark and click on its four outermost corners.</source>
        <translation>找到的角点。标定板漏检时，按“标记”并点击其最外侧的四个角点。</translation>
    </message>
    <message>
        <source>The verdict</source>
        <translation>结论</translation>
    </message>
    <message>
        <source>Whether the camera can be used, and how far off a point is in the image: at the centre, at the edge, at worst, and in mm at your distance.</source>
        <translation>相机能否使用，以及图像中一点偏离多少：在中心、边缘、最差处，以及在您的距离上以 mm 计。</translation>
    </message>
    <message>
        <source>What was done</source>
        <translation>已做的工作</translation>
    </message>
    <message>
        <source>Each step that made the camera better can be undone, or says why.</source>
        <translation>改进相机的每一步都可撤销，或说明原因。</translation>
    </message>
    <message>
        <source>Look closer</source>
        <translation>进一步查看</translation>
    </message>
    <message>
        <source>Each mode fills the desk: the method step by step, the fit, the lens, the board, and images without distortion.</source>
        <translation>每种模式填满桌面：逐步的方法、拟合、镜头、标定板和无畸变的图像。</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>设置</translation>
    </message>
    <message>
        <source>The board, the lens, and limits for PASS or FAIL.</source>
        <translation>标定板、镜头，以及判定 PASS 或 FAIL 的限值。</translation>
    </message>
    <message>
        <source>Take it with you</source>
        <translation>带走结果</translation>
    </message>
    <message>
        <source>Export writes the camera for other programs, Report a page for people.</source>
        <translation>“导出”为其他程序写出相机，“报告”为人写出一页。</translation>
    </message>
    <message>
        <source>Still good?</source>
        <translation>仍然好用？</translation>
    </message>
    <message>
        <source>Months later, drop a few new photographs on this side: they check the camera and change nothing.</source>
        <translation>几个月后，把几张新照片拖放到这一侧：它们检查相机，不改变任何东西。</translation>
    </message>
    <message>
        <source>{0} of {1}</source>
        <translation>{0} / {1}</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>下一步</translation>
    </message>
    <message>
        <source>Done</source>
        <translation>完成</translation>
    </message>
</context>
<context>
    <name>UncertaintyPanel</name>
    <message>
        <source>Uncertainty</source>
        <translation>不确定度</translation>
    </message>
    <message>
        <source>How well it is known where points are imaged.</source>
        <translation>点成像位置的已知精度。</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>far away</source>
        <translation>很远处</translation>
    </message>
    <message>
        <source>Of the points that the camera will look at; 0 for points far away.</source>
        <translation>相机将要看的点的距离；0 表示很远的点。</translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>The uncertainty that you can live with: the red line goes around it.</source>
        <translation>您可以接受的不确定度：红线围绕它。</translation>
    </message>
    <message>
        <source>P&amp;oints</source>
        <translation>点(&amp;O)</translation>
    </message>
    <message>
        <source>Limi&amp;t</source>
        <translation>限值(&amp;T)</translation>
    </message>
    <message>
        <source>one σ, worst direction [px]</source>
        <translation>一个 σ，最差方向 [px]</translation>
    </message>
    <message>
        <source>A point of the scene is imaged this far from where the calibration says (1σ).
What turning and shifting the camera would undo is taken out.
It is what the calibration says of itself. The verdict&apos;s error may be another:
where the remedy of a finding was tried, it is measured against the camera that
the remedy gives. Where there are no corners it adds how far another lens model
goes apart from this one that fits as well.</source>
        <translation>场景中一点的成像与标定所说之处相差这么多 (1σ)。
已去除相机转动和平移可抵消的部分。
这是标定对自身的说法。结论的误差可能不同：
试过某个问题的补救时，以补救得到的相机为准测量。
没有角点之处，还加上另一个拟合同样好的镜头模型
与此模型的差距。</translation>
    </message>
    <message>
        <source>Working…</source>
        <translation>正在计算…</translation>
    </message>
    <message>
        <source>Propagating the uncertainty</source>
        <translation>正在传播不确定度</translation>
    </message>
    <message>
        <source> (inside the red line)</source>
        <translation>（在红线内）</translation>
    </message>
    <message>
        <source>By this lens model points {0} are imaged to {1} px at the centre, {2} px in the median, {3} px at worst (1σ). {4:.0f} % of the image is known to {5:g} px or better{6}.</source>
        <translation>按此镜头模型，{0}的点在中心成像到 {1} px，中位数 {2} px，最差 {3} px (1σ)。图像的 {4:.0f} % 已知到 {5:g} px 或更好{6}。</translation>
    </message>
    <message>
        <source>{0:g} mm away</source>
        <translation>{0:g} mm 远处</translation>
    </message>
    <message>
        <source> The brightest colour is {0} px or more.</source>
        <translation> 最亮的颜色为 {0} px 或更多。</translation>
    </message>
    <message>
        <source>Point at the map to read it.</source>
        <translation>指向图即可读数。</translation>
    </message>
    <message>
        <source>u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, in all directions {3:.3f} px</source>
        <translation>u {0:.0f}，v {1:.0f}：σ = {2:.3f} px，所有方向 {3:.3f} px</translation>
    </message>
</context>
<context>
    <name>UndistortPanel</name>
    <message>
        <source>Undistort</source>
        <translation>去畸变</translation>
    </message>
    <message>
        <source>An image without the lens&apos;s distortion, or rectified to the board.</source>
        <translation>没有镜头畸变的图像，或按标定板校正的图像。</translation>
    </message>
    <message>
        <source>Angle from the left edge of the new image to the right one</source>
        <translation>新图像左边缘到右边缘的角度</translation>
    </message>
    <message>
        <source>Field of view in degrees</source>
        <translation>视场，度</translation>
    </message>
    <message>
        <source>Save &amp;this…</source>
        <translation>保存此图(&amp;T)…</translation>
    </message>
    <message>
        <source>&amp;Save all…</source>
        <translation>全部保存(&amp;S)…</translation>
    </message>
    <message>
        <source>Write the selected image as it is shown here into a folder</source>
        <translation>把所选图像按此处所示写入文件夹</translation>
    </message>
    <message>
        <source>Write all images like this into a folder, those that were left out as well</source>
        <translation>把所有图像按此写入文件夹，包括被排除的</translation>
    </message>
    <message>
        <source>as taken</source>
        <translation>原图</translation>
    </message>
    <message>
        <source>undistorted</source>
        <translation>已校正</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>透视</translation>
    </message>
    <message>
        <source>Cylindrical</source>
        <translation>圆柱</translation>
    </message>
    <message>
        <source>Equirectangular</source>
        <translation>等距柱状</translation>
    </message>
    <message>
        <source>Stereographic</source>
        <translation>球极</translation>
    </message>
    <message>
        <source>Cube</source>
        <translation>立方体</translation>
    </message>
    <message>
        <source>Rectified to the board</source>
        <translation>按标定板校正</translation>
    </message>
    <message>
        <source>Perspective keeps straight lines straight, and shows less than 180°.
Cylindrical unrolls the horizon; upright lines stay straight.
Equirectangular is a map of longitude and latitude, for viewers of 360° images.
Stereographic is a wide view in which small things keep their shape.
Cube makes perspective images of 90° to all sides.
Rectified shows the board from straight above.</source>
        <translation>透视保持直线，视场小于 180°。
圆柱展开地平线；竖线保持直。
等距柱状是经纬图，用于 360° 图像查看器。
球极是宽视野，小物体保持形状。
立方体向各面生成 90° 的透视图像。
校正显示从正上方看的标定板。</translation>
    </message>
    <message>
        <source>What to make of the image</source>
        <translation>对图像做什么</translation>
    </message>
    <message>
        <source>All pixels</source>
        <translation>所有像素</translation>
    </message>
    <message>
        <source>No black border</source>
        <translation>无黑边</translation>
    </message>
    <message>
        <source>Same scale</source>
        <translation>相同比例</translation>
    </message>
    <message>
        <source>Field of view</source>
        <translation>视场</translation>
    </message>
    <message>
        <source>All pixels keeps everything, with black beyond it; no black border cuts to a full rectangle;
same scale keeps the size of the middle; field of view shows an angle of your choice.</source>
        <translation>“所有像素”保留全部，外围为黑；“无黑边”裁成完整矩形；
“相同比例”保持中部大小；“视场”显示您选择的角度。</translation>
    </message>
    <message>
        <source>How much of the image to show</source>
        <translation>显示图像的多少</translation>
    </message>
    <message>
        <source>{0}: working…</source>
        <translation>{0}：正在计算…</translation>
    </message>
    <message>
        <source>Undistorting {0}</source>
        <translation>正在校正 {0}</translation>
    </message>
    <message>
        <source>{0}: {1} × {2} px</source>
        <translation>{0}：{1} × {2} px</translation>
    </message>
</context>
<context>
    <name>VerdictBar</name>
    <message>
        <source>Remedy</source>
        <translation>补救</translation>
    </message>
    <message>
        <source>Judging the calibration</source>
        <translation>正在评估标定</translation>
    </message>
    <message>
        <source>SEARCHING CORNERS…</source>
        <translation>正在查找角点…</translation>
    </message>
    <message>
        <source>CALIBRATING…</source>
        <translation>正在标定…</translation>
    </message>
    <message>
        <source>NOT CALIBRATED</source>
        <translation>未标定</translation>
    </message>
    <message>
        <source>KNOWN CAMERA</source>
        <translation>已知相机</translation>
    </message>
    <message>
        <source>FIRST FIT</source>
        <translation>首次拟合</translation>
    </message>
    <message>
        <source>JUDGING…</source>
        <translation>正在评估…</translation>
    </message>
    <message>
        <source>Of {0} photographs. {1}</source>
        <translation>基于 {0} 张照片。{1}</translation>
    </message>
    <message>
        <source>The new calibration is being made better, and judged.</source>
        <translation>新的标定正在改进和评估。</translation>
    </message>
    <message>
        <source>The new calibration is being judged: what makes it better is tried.</source>
        <translation>新的标定正在评估：正在尝试能改进它的办法。</translation>
    </message>
    <message>
        <source>No photograph can be used: click one to see why.</source>
        <translation>没有可用的照片：点击一张查看原因。</translation>
    </message>
    <message>
        <source>No board of the kind “{0}” was found: click a photograph to see why.</source>
        <translation>没有找到“{0}”类的标定板：点击照片查看原因。</translation>
    </message>
    <message>
        <source>Mark the board in the photographs (M), or let them be searched: Set-up.</source>
        <translation>请在照片中标记标定板 (M)，或让程序搜索：设置。</translation>
    </message>
    <message>
        <source>How far the camera can be trusted is said here once it is calibrated.</source>
        <translation>标定之后，这里会说明相机的可信程度。</translation>
    </message>
    <message>
        <source>&amp;1 finding</source>
        <translation>1 个问题(&amp;1)</translation>
    </message>
    <message>
        <source>{0} &amp;findings</source>
        <translation>{0} 个问题(&amp;F)</translation>
    </message>
    <message>
        <source>List what is wrong, with the figures that show it</source>
        <translation>列出问题及相关数据</translation>
    </message>
    <message>
        <source>Is it &amp;glass?</source>
        <translation>是玻璃吗(&amp;G)？</translation>
    </message>
    <message>
        <source>Say what it brings to state that the board is of glass</source>
        <translation>说明声明标定板为玻璃的好处</translation>
    </message>
    <message>
        <source>State a board of glass</source>
        <translation>声明为玻璃板</translation>
    </message>
</context>
<context>
    <name>VerdictTexts</name>
    <message>
        <source>GOOD</source>
        <translation>良好</translation>
    </message>
    <message>
        <source>USABLE</source>
        <translation>可用</translation>
    </message>
    <message>
        <source>CAN BE {0}× BETTER</source>
        <translation>可改进 {0} 倍</translation>
    </message>
    <message>
        <source>NOT USABLE</source>
        <translation>不可用</translation>
    </message>
    <message>
        <source>Error: unknown</source>
        <translation>误差：未知</translation>
    </message>
    <message>
        <source>Error: centre {0}, among corners {1}, edge {2}, worst {3} px</source>
        <translation>误差：中心 {0}，角点间 {1}，边缘 {2}，最差 {3} px</translation>
    </message>
    <message>
        <source>{0} mm at the edge, {1:.0f} mm away</source>
        <translation>边缘 {0} mm，距离 {1:.0f} mm</translation>
    </message>
    <message>
        <source>edge: {0} mm at {1} m</source>
        <translation>边缘：{1} m 处 {0} mm</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} circles</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px，{2:,} 个圆</translation>
    </message>
    <message>
        <source>RMS {0:.3f} px, σ {1:.3f} px of {2:,} corners</source>
        <translation>RMS {0:.3f} px, σ {1:.3f} px，{2:,} 个角点</translation>
    </message>
    <message>
        <source>Estimate the board&apos;s shape</source>
        <translation>估计标定板形状</translation>
    </message>
    <message>
        <source>Take the lens model that fits</source>
        <translation>采用合适的镜头模型</translation>
    </message>
    <message>
        <source>Leave these corners out</source>
        <translation>排除这些角点</translation>
    </message>
    <message>
        <source>Leave {0} out</source>
        <translation>排除 {0}</translation>
    </message>
    <message>
        <source>Free {0}</source>
        <translation>释放 {0}</translation>
    </message>
    <message>
        <source>Hold {0} at 0</source>
        <translation>把 {0} 固定为 0</translation>
    </message>
    <message>
        <source>Estimate the skew</source>
        <translation>估计切变</translation>
    </message>
    <message>
        <source>Weigh views by their noise</source>
        <translation>按噪声加权</translation>
    </message>
    <message>
        <source>Look at {0}</source>
        <translation>查看 {0}</translation>
    </message>
    <message>
        <source>Show where to hold the board</source>
        <translation>显示标定板该放在哪里</translation>
    </message>
</context>
<context>
    <name>Videos</name>
    <message>
        <source>Decoding {0}</source>
        <translation>正在解码 {0}</translation>
    </message>
    <message>
        <source>Finding corners</source>
        <translation>正在寻找角点</translation>
    </message>
</context>
<context>
    <name>Welcome</name>
    <message>
        <source>Calibrate a camera</source>
        <translation>标定相机</translation>
    </message>
    <message>
        <source>Drop photographs of a flat board here, or a saved project. The board&apos;s kind and size are found.</source>
        <translation>把平整标定板的照片拖放到这里，或已保存的项目。板的种类和大小会自动识别。</translation>
    </message>
    <message>
        <source>Open a f&amp;older of images</source>
        <translation>打开图像文件夹(&amp;O)</translation>
    </message>
    <message>
        <source>Corners are found and the camera is calibrated at once.</source>
        <translation>自动寻找角点并立即标定相机。</translation>
    </message>
    <message>
        <source>&amp;Photograph live</source>
        <translation>实时拍摄(&amp;P)</translation>
    </message>
    <message>
        <source>The camera&apos;s image shows where to hold the board.</source>
        <translation>相机画面会显示标定板该放在哪里。</translation>
    </message>
    <message>
        <source>&amp;Add images</source>
        <translation>添加图像(&amp;A)</translation>
    </message>
    <message>
        <source>Choose single files.</source>
        <translation>选择单个文件。</translation>
    </message>
    <message>
        <source>Open the &amp;sample</source>
        <translation>打开示例(&amp;S)</translation>
    </message>
    <message>
        <source>Fourteen rendered photographs, to look around.</source>
        <translation>十四张渲染的照片，供浏览。</translation>
    </message>
    <message>
        <source>Take the to&amp;ur</source>
        <translation>导览(&amp;U)</translation>
    </message>
    <message>
        <source>Prin&amp;t a board</source>
        <translation>打印标定板(&amp;T)</translation>
    </message>
    <message>
        <source>Two minutes on the sample; it can be left at any step.</source>
        <translation>用示例走两分钟；随时可以离开。</translation>
    </message>
    <message>
        <source>A checkerboard, or one of the other kinds, in true size.</source>
        <translation>棋盘格或其他种类，真实大小。</translation>
    </message>
    <message>
        <source>Recent projects and folders</source>
        <translation>最近的项目和文件夹</translation>
    </message>
</context>
<context>
    <name>WorldReading</name>
    <message>
        <source>ray {0:.2f}° {1}, {2:.2f}° {3}</source>
        <translation>射线 {0:.2f}° {1}，{2:.2f}° {3}</translation>
    </message>
    <message>
        <source>left</source>
        <translation>左</translation>
    </message>
    <message>
        <source>right</source>
        <translation>右</translation>
    </message>
    <message>
        <source>up</source>
        <translation>上</translation>
    </message>
    <message>
        <source>down</source>
        <translation>下</translation>
    </message>
    <message>
        <source>   board X {0:.2f}, Y {1:.2f} mm</source>
        <translation>   板 X {0:.2f}，Y {1:.2f} mm</translation>
    </message>
</context>
<context>
    <name>actions</name>
    <message>
        <source>Close</source>
        <translation>关闭</translation>
    </message>
</context>
<context>
    <name>files</name>
    <message>
        <source>Replace a file</source>
        <translation>替换文件</translation>
    </message>
    <message>
        <source>{0} exists. Replace it?</source>
        <translation>{0} 已存在。要替换吗？</translation>
    </message>
</context>
<context>
    <name>glossary</name>
    <message>
        <source>Focal length along the image&apos;s rows, in widths of a pixel.</source>
        <translation>沿图像行的焦距，以像素宽度计。</translation>
    </message>
    <message>
        <source>Focal length along the image&apos;s columns, in heights of a pixel.</source>
        <translation>沿图像列的焦距，以像素高度计。</translation>
    </message>
    <message>
        <source>Column of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>主点的列，即镜头光轴与之相交处，px。</translation>
    </message>
    <message>
        <source>Row of the principal point, where the lens&apos;s axis meets it, px.</source>
        <translation>主点的行，即镜头光轴与之相交处，px。</translation>
    </message>
    <message>
        <source>Lean of the pixel&apos;s columns, px; 0 for every sensor of today.</source>
        <translation>像素列的倾斜，px；当今的传感器均为 0。</translation>
    </message>
    <message>
        <source>First coefficient of the radial distortion, of the lowest power.</source>
        <translation>径向畸变的第一系数，最低次。</translation>
    </message>
    <message>
        <source>Second coefficient of the radial distortion.</source>
        <translation>径向畸变的第二系数。</translation>
    </message>
    <message>
        <source>Third coefficient of the radial distortion.</source>
        <translation>径向畸变的第三系数。</translation>
    </message>
    <message>
        <source>Decentering distortion, of a lens whose elements are out of line.</source>
        <translation>偏心畸变，来自镜片未对准的镜头。</translation>
    </message>
    <message>
        <source>Growth of the decentering distortion with the radius squared.</source>
        <translation>偏心畸变随半径平方的增长。</translation>
    </message>
    <message>
        <source>The value with its standard deviation: two times in three it is so far off or less.</source>
        <translation>值及其标准差：三次中有两次偏差不超过它。</translation>
    </message>
    <message>
        <source>Standard deviation: two times in three a value is so far off or less.</source>
        <translation>标准差：三次中有两次值的偏差不超过它。</translation>
    </message>
    <message>
        <source>in σ</source>
        <translation>以 σ 计</translation>
    </message>
    <message>
        <source>A difference in standard deviations: more than 3 is hardly chance.</source>
        <translation>以标准差计的差异：超过 3 几乎不是偶然。</translation>
    </message>
    <message>
        <source>SD of Table 2</source>
        <translation>表 2 的标准差</translation>
    </message>
    <message>
        <source>The standard deviation as the paper computes it, which leaves the size of the residuals out.</source>
        <translation>论文计算的标准差，不计残差的大小。</translation>
    </message>
    <message>
        <source>Root mean square: the typical length of the residuals, in which large ones count most.</source>
        <translation>均方根：残差的典型长度，大的影响最多。</translation>
    </message>
    <message>
        <source>residual</source>
        <translation>残差</translation>
    </message>
    <message>
        <source>What a corner was measured at, less where camera and board put it.</source>
        <translation>测得的角点位置减去相机和标定板给出的位置。</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s rows: measured less predicted column.</source>
        <translation>沿图像行的残差：测得列减预测列。</translation>
    </message>
    <message>
        <source>Residual along the image&apos;s columns: measured less predicted row.</source>
        <translation>沿图像列的残差：测得行减预测行。</translation>
    </message>
    <message>
        <source>Length of a residual in the image.</source>
        <translation>残差在图像中的长度。</translation>
    </message>
    <message>
        <source>reference px</source>
        <translation>参考 px</translation>
    </message>
    <message>
        <source>The paper&apos;s unit on the board: a square has 30 of them, whatever its size in the image.</source>
        <translation>论文在板上的单位：每个方格有 30 个，不论其在图像中的大小。</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s rows, on the paper&apos;s reference plane.</source>
        <translation>沿板的行的残差，在论文的参考平面上。</translation>
    </message>
    <message>
        <source>Residual along the board&apos;s columns, on the paper&apos;s reference plane.</source>
        <translation>沿板的列的残差，在论文的参考平面上。</translation>
    </message>
    <message>
        <source>Length of a residual on the paper&apos;s reference plane, where a square has 30 px.</source>
        <translation>残差在论文参考平面上的长度，每方格 30 px。</translation>
    </message>
    <message>
        <source>aspect ratio</source>
        <translation>纵横比</translation>
    </message>
    <message>
        <source>Width of a pixel over its height, fy over fx; 1 for square pixels.</source>
        <translation>像素的宽高比，fy 比 fx；方形像素为 1。</translation>
    </message>
    <message>
        <source>The paper&apos;s equation of cosines: where it is 0, r is the aspect ratio that one view gives by itself.</source>
        <translation>论文的余弦方程：为 0 处，r 是一个视图单独给出的纵横比。</translation>
    </message>
    <message>
        <source>cost c</source>
        <translation>代价 c</translation>
    </message>
    <message>
        <source>The mean squared residual that the calibration makes as small as it can.</source>
        <translation>标定使之尽可能小的均方残差。</translation>
    </message>
    <message>
        <source>iteration</source>
        <translation>迭代</translation>
    </message>
    <message>
        <source>One improvement of all parameters together.</source>
        <translation>所有参数一起的一次改进。</translation>
    </message>
    <message>
        <source>density</source>
        <translation>密度</translation>
    </message>
    <message>
        <source>Share of the residuals for each px of their length, so that all bars have area 1.</source>
        <translation>每 px 长度的残差占比，使所有条的面积为 1。</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>距离</translation>
    </message>
    <message>
        <source>Distance from the camera to the middle of the board.</source>
        <translation>从相机到标定板中心的距离。</translation>
    </message>
    <message>
        <source>tilt</source>
        <translation>倾斜</translation>
    </message>
    <message>
        <source>Angle between the board and the image plane; 0 if the camera looks straight at it.</source>
        <translation>标定板与像平面的夹角；相机正对时为 0。</translation>
    </message>
    <message>
        <source>displacement d</source>
        <translation>位移 d</translation>
    </message>
    <message>
        <source>How far the lens moves the image of a point from where a pinhole would put it.</source>
        <translation>镜头把一点的像从针孔成像处移动了多少。</translation>
    </message>
    <message>
        <source>one σ, worst direction</source>
        <translation>一个 σ，最差方向</translation>
    </message>
    <message>
        <source>How uncertain the image of a point is along the direction in which that is worst.</source>
        <translation>一点的像在最不确定的方向上有多不确定。</translation>
    </message>
    <message>
        <source>correlated errors</source>
        <translation>相关误差</translation>
    </message>
    <message>
        <source>Errors of neighbouring corners that point the same way, so that many corners tell less than their number.</source>
        <translation>相邻角点指向相同方向的误差，使许多角点的信息少于其数目。</translation>
    </message>
    <message>
        <source>share errors</source>
        <translation>共有误差</translation>
    </message>
    <message>
        <source>Of corners: neighbours are off alike, so that many tell less than their number.</source>
        <translation>关于角点：相邻角点偏差相同，使许多角点的信息少于其数目。</translation>
    </message>
    <message>
        <source>unseen views</source>
        <translation>未见视图</translation>
    </message>
    <message>
        <source>Views that were left out of a calibration, to see how well it predicts them.</source>
        <translation>标定时排除的视图，用来看它预测得如何。</translation>
    </message>
    <message>
        <source>Bayesian information criterion: misfit plus a price for each parameter; the least is best.</source>
        <translation>贝叶斯信息准则：失配加上每个参数的代价；最小者最好。</translation>
    </message>
    <message>
        <source>Column of a pixel: 0 at the middle of the leftmost one.</source>
        <translation>像素的列：最左像素的中心为 0。</translation>
    </message>
    <message>
        <source>Row of a pixel: 0 at the middle of the topmost one, growing downwards.</source>
        <translation>像素的行：最上像素的中心为 0，向下增大。</translation>
    </message>
</context>
<context>
    <name>lengths</name>
    <message>
        <source> if circles are {0:g} mm apart</source>
        <translation>（若圆间距为 {0:g} mm）</translation>
    </message>
    <message>
        <source> if tags are {0:g} mm</source>
        <translation>（若标签为 {0:g} mm）</translation>
    </message>
    <message>
        <source> if squares are {0:g} mm</source>
        <translation>（若方格为 {0:g} mm）</translation>
    </message>
    <message>
        <source>Lengths hold{0}.</source>
        <translation>长度成立{0}。</translation>
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
        <translation>照片</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>方法</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>拟合</translation>
    </message>
    <message>
        <source>Lens</source>
        <translation>镜头</translation>
    </message>
    <message>
        <source>Board</source>
        <translation>标定板</translation>
    </message>
    <message>
        <source>3-D</source>
        <translation>三维</translation>
    </message>
    <message>
        <source>Undistort</source>
        <translation>去畸变</translation>
    </message>
    <message>
        <source>Compare</source>
        <translation>比较</translation>
    </message>
    <message>
        <source>The photographs, and what was found in them.</source>
        <translation>照片，以及在其中找到的内容。</translation>
    </message>
    <message>
        <source>How the camera was found, step by step as in the paper.</source>
        <translation>相机如何得出，像论文那样逐步展示。</translation>
    </message>
    <message>
        <source>How well the photographs agree, and every value.</source>
        <translation>照片彼此吻合的程度，以及每个数值。</translation>
    </message>
    <message>
        <source>What the lens does, and which model describes it.</source>
        <translation>镜头做了什么，用哪个模型描述。</translation>
    </message>
    <message>
        <source>How the real board differs from the drawing.</source>
        <translation>实际标定板与图纸的差别。</translation>
    </message>
    <message>
        <source>Where the board was held, and where to hold it next.</source>
        <translation>标定板曾放在哪里，下一次放在哪里。</translation>
    </message>
    <message>
        <source>Photographs without the distortion of the lens.</source>
        <translation>没有镜头畸变的照片。</translation>
    </message>
    <message>
        <source>Two results side by side.</source>
        <translation>两个结果并排。</translation>
    </message>
</context>
<context>
    <name>plots</name>
    <message>
        <source>Copy as image</source>
        <translation>复制为图像</translation>
    </message>
    <message>
        <source>Save plot…</source>
        <translation>保存图表…</translation>
    </message>
    <message>
        <source>Save plot</source>
        <translation>保存图表</translation>
    </message>
    <message>
        <source>PNG image (*.png);;SVG drawing (*.svg)</source>
        <translation>PNG 图像 (*.png);;SVG 图 (*.svg)</translation>
    </message>
</context>
<context>
    <name>questions</name>
    <message>
        <source>&amp;Yes</source>
        <translation>是(&amp;Y)</translation>
    </message>
    <message>
        <source>&amp;No</source>
        <translation>否(&amp;N)</translation>
    </message>
    <message>
        <source>&amp;Save</source>
        <translation>保存(&amp;S)</translation>
    </message>
    <message>
        <source>Save &amp;as…</source>
        <translation>另存为(&amp;A)…</translation>
    </message>
    <message>
        <source>&amp;Discard</source>
        <translation>放弃(&amp;D)</translation>
    </message>
    <message>
        <source>&amp;Cancel</source>
        <translation>取消(&amp;C)</translation>
    </message>
</context>
<context>
    <name>status_text</name>
    <message>
        <source>not searched</source>
        <translation>未搜索</translation>
    </message>
    <message>
        <source>no board</source>
        <translation>无标定板</translation>
    </message>
    <message>
        <source>unreadable</source>
        <translation>无法读取</translation>
    </message>
    <message>
        <source>wrong size</source>
        <translation>尺寸不符</translation>
    </message>
    <message>
        <source>found</source>
        <translation>已找到</translation>
    </message>
    <message>
        <source>{0} of {1}, ambiguous</source>
        <translation>{1} 中的 {0}，有歧义</translation>
    </message>
    <message>
        <source>{0} of {1} corners</source>
        <translation>{0} / {1} 个角点</translation>
    </message>
    <message>
        <source>{0} corners</source>
        <translation>{0} 个角点</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>已排除</translation>
    </message>
</context>
<context>
    <name>status_tip</name>
    <message>
        <source>Which part of the board is seen cannot be decided from it.</source>
        <translation>无法由此判断见到的是板的哪一部分。</translation>
    </message>
    <message>
        <source>A turn of the board by {0} cannot be seen in its pattern.</source>
        <translation>板旋转 {0} 从其图案看不出来。</translation>
    </message>
    <message>
        <source>Another board is seen here, of {0} × {1} inner corners.</source>
        <translation>这里见到的是另一块板，{0} × {1} 个内角点。</translation>
    </message>
</context>
</TS>
