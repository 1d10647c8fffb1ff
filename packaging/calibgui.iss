; The installer for Windows, of the folder that PyInstaller wrote:
;   iscc /DVersion=0.1.0 packaging\calibgui.iss
; It needs no administrator: without one the program is installed for the user alone.
[Setup]
AppName=calibgui
AppVersion={#Version}
AppPublisher=The calibgui authors
DefaultDirName={autopf}\calibgui
DefaultGroupName=calibgui
DisableProgramGroupPage=yes
PrivilegesRequired=lowest
PrivilegesRequiredOverridesAllowed=dialog
LicenseFile=..\LICENSE
OutputDir=..\dist
OutputBaseFilename=calibgui-{#Version}-setup
UninstallDisplayIcon={app}\calibgui-window.exe
ArchitecturesAllowed=x64compatible
ArchitecturesInstallIn64BitMode=x64compatible
SolidCompression=yes
WizardStyle=modern

[Files]
Source: "..\dist\calibgui\*"; DestDir: "{app}"; Flags: recursesubdirs ignoreversion

[Icons]
Name: "{group}\calibgui"; Filename: "{app}\calibgui-window.exe"
Name: "{autodesktop}\calibgui"; Filename: "{app}\calibgui-window.exe"; Tasks: desktop

[Tasks]
Name: desktop; Description: "An icon on the desktop"; Flags: unchecked

[Run]
Filename: "{app}\calibgui-window.exe"; Description: "Start calibgui"; Flags: nowait postinstall skipifsilent
